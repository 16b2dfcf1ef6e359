#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A Slurm of this one machine, to try things: no installation, no system services. As the user who
# starts it; needs the packages slurm-wlm and munge.
#   source <(scripts/slurm/one_node.sh start FOLDER)   # starts it and sets SLURM_CONF
#   scripts/slurm/one_node.sh stop FOLDER
set -euo pipefail
PATH=$PATH:/usr/sbin:/sbin

[ $# = 2 ] || { echo "usage: one_node.sh start|stop FOLDER" >&2; exit 2; }
mkdir -p "$2"
folder=$(readlink -f "$2")

start() {
  local program
  for program in munged slurmctld slurmd sbatch; do
    command -v "$program" >/dev/null || { echo "one_node.sh: no $program (packages slurm-wlm, munge)" >&2; exit 1; }
  done
  mkdir -p "$folder"/{state,spool,munge}
  chmod 700 "$folder/munge"
  dd if=/dev/urandom of="$folder/munge/key" bs=128 count=1 2>/dev/null
  chmod 400 "$folder/munge/key"
  munged --force --socket="$folder/munge/socket" --key-file="$folder/munge/key" \
    --log-file="$folder/munge/log" --pid-file="$folder/munge/pid" --seed-file="$folder/munge/seed" >&2
  local host user memory
  host=$(hostname -s) user=$(id -un)
  memory=$(($(awk '/^MemTotal/ {print $2}' /proc/meminfo) * 9 / 10240))
  cat >"$folder/slurm.conf" <<CONF
ClusterName=one
SlurmctldHost=$host(127.0.0.1)
SlurmUser=$user
SlurmdUser=$user
SlurmctldPort=$((20000 + $$ % 10000))
SlurmdPort=$((30000 + $$ % 10000))
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
ReturnToService=2
MpiDefault=none
SlurmctldParameters=enable_configless
SlurmdParameters=config_overrides
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
SchedulerParameters=sched_interval=1,bf_interval=1
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=$memory State=UNKNOWN
PartitionName=main Nodes=$host Default=YES DefMemPerCPU=$((memory / $(nproc))) MaxTime=INFINITE State=UP
CONF
  export SLURM_CONF=$folder/slurm.conf
  slurmctld -f "$SLURM_CONF" >&2
  slurmd -f "$SLURM_CONF" -N "$host" >&2
  local i
  for ((i = 0; i < 100; ++i)); do
    sinfo --noheader --format=%t 2>/dev/null | grep -qE '^(idle|mix|alloc)' && break
    sleep 0.2
  done
  sinfo --noheader --format=%t 2>/dev/null | grep -qE '^(idle|mix|alloc)' || {
    echo "one_node.sh: the node does not come up; see $folder/*.log" >&2
    stop
    exit 1
  }
  echo "export SLURM_CONF='$SLURM_CONF'"
}

stop() {
  local file
  for file in slurmd.pid slurmctld.pid munge/pid; do
    [ -f "$folder/$file" ] && kill "$(cat "$folder/$file")" 2>/dev/null
    rm -f "$folder/$file"
  done
  return 0
}

case "$1" in
  start) start ;;
  stop) stop ;;
  *) echo "usage: one_node.sh start|stop FOLDER" >&2; exit 2 ;;
esac
