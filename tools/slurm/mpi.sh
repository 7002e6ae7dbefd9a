#!/usr/bin/env bash
# Makes one region with all tasks of a job, over MPI.
#   sbatch --ntasks=8 --cpus-per-task=4 tools/slurm/mpi.sh OUT [options of psygen amplify]
#SBATCH --job-name=psygen
#SBATCH --requeue
#SBATCH --open-mode=append
set -euo pipefail
out="$1"
shift
exec mpirun --map-by "slot:PE=${SLURM_CPUS_PER_TASK:-1}" "${PSYGEN:-psygen}" amplify --out "$out" \
  --threads "${SLURM_CPUS_PER_TASK:-1}" "$@"
