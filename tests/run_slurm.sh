#!/usr/bin/env bash
# Runs a batch of two sequences, one of them broken, first locally and then on a one-node Slurm cluster that this script
# starts, and compares the results.
#   run_slurm.sh QUADEDGE PYTHON
set -euo pipefail
quadedge="$1" python="$2"
for tool in munged slurmctld slurmd sbatch srun squeue sinfo; do
  PATH="$PATH:/usr/sbin" command -v "$tool" >/dev/null ||
    { echo "$tool is missing; scripts/test.sh installs Slurm"; exit 1; }
done
folder="$(mktemp -d)"
chmod 711 "$folder"  # munge requires that everybody can reach its socket
stop() {
  local status=$? pid_file
  if [ $status -ne 0 ]; then tail -n 20 "$folder"/slurm/*.log 2>/dev/null || true; fi
  for pid_file in "$folder"/slurm/{slurmd,slurmctld,munged}.pid; do
    if [ -f "$pid_file" ]; then kill "$(cat "$pid_file")" || true; fi
  done
  sleep 0.5  # they write their state while they exit
  rm -rf "$folder"
}
trap stop EXIT
fail() { echo "$1"; exit 1; }

"$quadedge" synth "$folder/data/good" --frames 4 --size 240x150 --quiet
cp -r "$folder/data/good" "$folder/data/broken"
rm "$folder/data/broken/calibration2.txt"
export QUADEDGE_PYTHON="$python"
batch() {  # OUT OPTION...: checks that the batch ends with the exit code and the name of the broken sequence
  local out="$1" code=0
  shift
  (cd "$folder" && "$quadedge" batch data -o "$out" "$@") >"$folder/$out.log" 2>&1 || code=$?
  [ $code -eq 3 ] || { cat "$folder/$out.log"; fail "expected exit code 3, found $code"; }
  grep -q "broken (failed): .*calibration2.txt" "$folder/$out.log" ||
    { cat "$folder/$out.log"; fail "the error does not name the broken sequence"; }
  for file in summary.json summary.md report.html \
    sequences/good/trajectory.txt sequences/broken/member.json; do
    [ -s "$folder/$out/$file" ] || { cat "$folder/$out.log"; fail "$out/$file is missing"; }
  done
}

echo "locally"
batch local

echo "on Slurm"
mkdir -p "$folder/slurm"/{state,spool,bin}
chmod 711 "$folder/slurm"
head -c 1024 /dev/urandom >"$folder/slurm/key"
chmod 600 "$folder/slurm/key"
free_port() { "$python" -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'; }
host="$(hostname -s)" user="$(id -un)"
cat >"$folder/slurm/slurm.conf" <<CONFIGURATION
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$folder/slurm/munge.socket
StateSaveLocation=$folder/slurm/state
SlurmdSpoolDir=$folder/slurm/spool
SlurmctldPidFile=$folder/slurm/slurmctld.pid
SlurmdPidFile=$folder/slurm/slurmd.pid
SlurmctldLogFile=$folder/slurm/slurmctld.log
SlurmdLogFile=$folder/slurm/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
MailProg=/bin/true
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=2000 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONFIGURATION
# Snakemake's jobs unset SLURM_CONF before they call srun, which would then read /etc, where tests do not write.
printf '#!/bin/sh\nSLURM_CONF=%s exec %s "$@"\n' "$folder/slurm/slurm.conf" "$(command -v srun)" \
  >"$folder/slurm/bin/srun"
chmod +x "$folder/slurm/bin/srun"
export SLURM_CONF="$folder/slurm/slurm.conf" PATH="$folder/slurm/bin:$PATH:/usr/sbin"
munged --key-file="$folder/slurm/key" --socket="$folder/slurm/munge.socket" --pid-file="$folder/slurm/munged.pid" \
  --log-file="$folder/slurm/munged.log" --seed-file="$folder/slurm/seed"
slurmctld
slurmd
for _ in $(seq 100); do
  if sinfo --noheader --format=%T 2>/dev/null | grep -q idle; then break; fi
  sleep 0.2
done
sinfo --noheader --format=%T | grep -q idle || fail "the node does not start: $(sinfo 2>&1)"
batch cluster -- --executor slurm --jobs 2 --default-resources slurm_partition=main runtime=5 mem_mb=900 \
  --slurm-no-account --slurm-status-command squeue --slurm-init-seconds-before-status-checks 1 \
  --seconds-between-status-checks 1
jobs="$(squeue --states=all --noheader --format=%T | sort | uniq -c | tr -s ' ')"
[ "$jobs" = " 2 COMPLETED" ] || fail "expected two completed Slurm jobs, found: $jobs"
for file in trajectory.txt trajectory_kitti.txt errors.csv config.toml member.json; do
  cmp "$folder/local/sequences/good/$file" "$folder/cluster/sequences/good/$file"
done
cmp "$folder/local/sequences/broken/member.json" "$folder/cluster/sequences/broken/member.json"
echo "two jobs on Slurm, the same results as locally"
