#!/usr/bin/env bash
# Checks and joins the shards of tools/slurm/shards.sh.
#   sbatch --dependency=afterok:JOB tools/slurm/merge.sh OUT
#SBATCH --job-name=psygen-merge
#SBATCH --ntasks=1
set -euo pipefail
exec "${PSYGEN:-psygen}" merge "$@"
