#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A batch on a Slurm cluster: an array job over its shards, further arrays that try failed scenes
# again, and a last job that writes the summary of all.
#   scripts/slurm/submit.sh --shards 16 [--retries 1] [SBATCH OPTIONS] -- BATCH ARGUMENTS
#   scripts/slurm/submit.sh --shards 16 --cpus-per-task=8 --mem=8G -- --list scenes.txt --out results
# The output folder must be on a file system that all nodes see and that knows locks. Prints the
# number of the last job. Set SKETCHSPLAT if the program is not on the path of the nodes.
set -euo pipefail
here=$(dirname "$(readlink -f "$0")")

usage() {
  echo "usage: submit.sh --shards N [--retries N] [SBATCH OPTIONS] -- BATCH ARGUMENTS" >&2
  exit 2
}

shards=0 retries=1 sbatch_options=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do
  case "$1" in
    --shards) shards=${2:-0}; shift 2 ;;
    --retries) retries=${2:-0}; shift 2 ;;
    *) sbatch_options+=("$1"); shift ;;
  esac
done
[ "${1:-}" = -- ] && [ "$shards" -gt 0 ] 2>/dev/null || usage
shift

submit() { sbatch --parsable --export=ALL "${sbatch_options[@]}" "$@" | cut -d';' -f1; }

job=$(submit --job-name=sketchsplat --array="1-$shards" "$here/array.sh" "$@")
for ((i = 0; i < retries; ++i)); do
  # What is done is not done again: these tasks are short, unless something failed.
  job=$(submit --job-name=sketchsplat-again --dependency="afterany:$job" --array="1-$shards" \
    "$here/array.sh" "$@")
done
submit --job-name=sketchsplat-merge --dependency="afterany:$job" "$here/merge.sh" "$@"
