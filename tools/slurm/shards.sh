#!/usr/bin/env bash
# Makes one shard of a region in each task of a job array; run tools/slurm/merge.sh afterwards.
#   sbatch --array=1-N tools/slurm/shards.sh N OUT [options of psygen amplify: --world, --region, --format …]
# Every shard may be killed, requeued and submitted again (--array=3): it resumes.
#SBATCH --job-name=psygen-shards
#SBATCH --ntasks=1
#SBATCH --requeue
#SBATCH --open-mode=append
set -euo pipefail
shards="$1" out="$2"
shift 2
exec "${PSYGEN:-psygen}" amplify --shard "$SLURM_ARRAY_TASK_ID/$shards" --out "$out" \
  --threads "${SLURM_CPUS_PER_TASK:-1}" "$@"
