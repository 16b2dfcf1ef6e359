#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# One task of a job array: its shard of a batch. Arguments are those of `sketchsplat batch`.
#   sbatch --array=1-16 --cpus-per-task=8 --mem=8G scripts/slurm/array.sh --list scenes.txt --out results
# SKETCHSPLAT says where the program is. Scenes that fail do not fail the task: they stand in the
# summary, and whoever submits a second array tries them again.
#SBATCH --signal=B:TERM@30
set -uo pipefail
first=${SLURM_ARRAY_TASK_MIN:-1}
last=${SLURM_ARRAY_TASK_MAX:-1}
shard=$((${SLURM_ARRAY_TASK_ID:-1} - first + 1))/$((last - first + 1))
"${SKETCHSPLAT:-sketchsplat}" batch "$@" --shard "$shard" &
worker=$!
# Slurm's SIGTERM, before a time limit or when the job is moved, goes to the batch: it stops at
# once, and its scenes are whole or open. The same command goes on.
trap 'kill -TERM "$worker" 2>/dev/null' TERM INT
wait "$worker"
status=$?
while kill -0 "$worker" 2>/dev/null; do
  wait "$worker"
  status=$?
done
[ "$status" = 6 ] && exit 0
exit "$status"
