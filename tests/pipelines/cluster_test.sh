#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# cluster_test.sh slurm|parallel BINARY SOURCE FOLDER: the same scenes in one run and as shards, by
# a Slurm of one node that this script starts, or by GNU parallel. The trees must be equal. Exit
# status 77, with a word, where the tool is missing.
set -euo pipefail
tool=$1 binary=$2 source=$(readlink -f "$3") folder=$4
SKETCHSPLAT=$(readlink -f "$binary")
export SKETCHSPLAT
PATH=$PATH:/usr/sbin:/sbin

skip() { echo "skipped: $*"; exit 77; }
fail() { echo "failed: $*" >&2; exit 1; }

case "$tool" in
  slurm) for program in slurmctld slurmd sbatch munged; do
    command -v "$program" >/dev/null || skip "no $program here (packages slurm-wlm and munge)"
  done ;;
  parallel) command -v parallel >/dev/null || skip "no GNU parallel here (package parallel)" ;;
esac

rm -rf "$folder"
mkdir -p "$folder/scenes/broken"
echo '{' >"$folder/scenes/broken/meta_data.json"
for i in 1 2 3 4 5 6; do
  "$SKETCHSPLAT" synthesize box --views 12 --resolution 160 --outputs none --quiet --seed "$i" \
    --out "$folder/scenes/s$i" >/dev/null
done
ls -d "$folder"/scenes/*/ >"$folder/list"
batch=(--list "$folder/list" --preset fast --quiet)

expect_failed() {  # one scene is broken: status 6, and nothing else
  local status=0
  "$@" >/dev/null 2>"$folder/err" || status=$?
  [ "$status" = 6 ] || fail "status $status of $*: $(cat "$folder/err")"
}
same() {
  diff -r --exclude=.batch "$folder/whole" "$1" || fail "$1 is not as one run wrote it"
}

expect_failed "$SKETCHSPLAT" batch "${batch[@]}" --out "$folder/whole"

if [ "$tool" = parallel ]; then
  seq 3 | parallel "$SKETCHSPLAT" batch "${batch[@]}" --out "$folder/results" --jobs 1 --shard {}/3 \
    >/dev/null 2>&1 || true
  expect_failed "$SKETCHSPLAT" batch "${batch[@]}" --out "$folder/results" --merge
  same "$folder/results"
  # As docs/batch.md says it for machines that share no file system.
  seq 3 | parallel "$SKETCHSPLAT" batch "${batch[@]}" --out "$folder/part{}" --jobs 1 --shard {}/3 \
    >/dev/null 2>&1 || true
  for i in 1 2 3; do mkdir -p "$folder/parts" && cp -r "$folder/part$i/." "$folder/parts/"; done
  expect_failed "$SKETCHSPLAT" batch "${batch[@]}" --out "$folder/parts" --merge
  same "$folder/parts"
  echo "passed"
  exit 0
fi

slurm=$(mktemp -d)  # a short path: of sockets
trap '"$source/scripts/slurm/one_node.sh" stop "$slurm"; rm -rf "$slurm" || { sleep 2; rm -rf "$slurm"; } || true' EXIT
environment=$("$source/scripts/slurm/one_node.sh" start "$slurm" 2>"$folder/slurm.err") ||
  skip "Slurm does not start here: $(tail -n 1 "$folder/slurm.err")"
eval "$environment"

finished() {  # JOB: waits for it, at most two minutes
  local i
  for ((i = 0; i < 600; ++i)); do
    squeue --noheader --jobs="$1" 2>/dev/null | grep -q . || return 0
    sleep 0.2
  done
  squeue >&2
  fail "job $1 does not end; see $slurm/*.log: $(tail -n 5 "$slurm"/*.log)"
}
submit() {
  "$source/scripts/slurm/submit.sh" --shards 3 --retries 1 --cpus-per-task=1 --mem=500M \
    --chdir="$folder" --output="$folder/job-%A-%a.txt" -- "${batch[@]}" --out "$1"
}

job=$(submit "$folder/results")
finished "$job"
same "$folder/results"
[ "$(grep -c . "$folder/results/.batch/timings.csv")" = 8 ] || fail "timings of all scenes expected"

# Tasks that somebody cancels: the array after them does the rest.
job=$(submit "$folder/cancelled")
for ((i = 0; i < 600; ++i)); do
  compgen -G "$folder/cancelled/s*" >/dev/null && break
  sleep 0.05
done
scancel --name=sketchsplat
finished "$job"
same "$folder/cancelled"
echo "passed"
