#!/usr/bin/env bash
# A Slurm of one machine to try and test `rilo bench --on slurm` with. Keys, sockets, state and logs are in DIR, the
# ports are random: nothing of the system is configured or touched.
#
#   scripts/slurm_local.sh start DIR      controller, node and munge; then:  export SLURM_CONF=DIR/slurm.conf
#   scripts/slurm_local.sh stop DIR       ends them and the jobs that still run
#   scripts/slurm_local.sh check          whether Debian's packages slurmctld, slurmd, slurm-client, munge are there
#
# Runs as root or as a user, in a container too: no cgroups, no systemd. RILO_SLURM_CPUS: processors that Slurm is told of.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
PATH="$PATH:/usr/sbin:/sbin"

have_slurm() { command -v slurmctld && command -v slurmd && command -v munged && command -v sbatch; } >/dev/null

free_port() {
  local port
  while :; do
    port=$((20000 + RANDOM % 40000))
    (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null || break
  done
  echo "$port"
}

# Waits for a command to succeed.
wait_for() {
  local tries="$1"
  shift
  for _ in $(seq "$tries"); do
    "$@" >/dev/null 2>&1 && return 0
    sleep 0.2
  done
  return 1
}

write_configuration() {
  local dir="$1" host user
  host="$(hostname -s)"
  user="$(id -un)"
  cat >"$dir/slurm.conf" <<CONF
ClusterName=rilo
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$dir/munge.sock
CredType=cred/munge
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.pid
SlurmctldLogFile=$dir/slurmctld.log
SlurmdLogFile=$dir/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/filetxt
JobCompLoc=$dir/jobs.txt
SchedulerType=sched/backfill
SchedulerParameters=bf_interval=1,sched_min_interval=100000
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
KillWait=2
MinJobAge=600
NodeName=$host NodeAddr=127.0.0.1 CPUs=${RILO_SLURM_CPUS:-$(nproc)} State=UNKNOWN
PartitionName=rilo Nodes=$host Default=YES MaxTime=INFINITE State=UP OverSubscribe=NO
CONF
}

start_munge() {
  local dir="$1"
  (umask 077 && dd if=/dev/urandom of="$dir/munge.key" bs=1 count=1024 status=none)
  munged --force --key-file="$dir/munge.key" --socket="$dir/munge.sock" --pid-file="$dir/munged.pid" \
    --log-file="$dir/munged.log" --seed-file="$dir/munged.seed" --num-threads=2 2>"$dir/munged.err" ||
    die "munged does not start, see $dir/munged.err and $dir/munged.log"
}

# Nothing of a Slurm that did not start goes on.
fail() {
  stop "$1"
  die "$2"
}

start() {
  local dir="$1"
  [[ "$dir$PWD" != *" "* ]] || die "$dir: Slurm's configuration takes no path with a space"
  have_slurm || die "no Slurm here: apt-get install --no-install-recommends slurmctld slurmd slurm-client munge"
  mkdir -p "$dir/state" "$dir/spool"
  dir="$(cd "$dir" && pwd)"
  chmod 755 "$dir"
  [ ! -S "$dir/munge.sock" ] || die "$dir: a Slurm was started here before; stop it first"
  write_configuration "$dir"
  start_munge "$dir"
  export SLURM_CONF="$dir/slurm.conf"
  slurmctld -f "$SLURM_CONF" 2>"$dir/slurmctld.err" || fail "$dir" "slurmctld does not start, see $dir/slurmctld.log"
  slurmd -f "$SLURM_CONF" 2>"$dir/slurmd.err" || fail "$dir" "slurmd does not start, see $dir/slurmd.log"
  # Ready when the node takes jobs.
  wait_for 150 sh -c "sinfo --noheader --format=%t | grep -qx idle" ||
    fail "$dir" "the node does not become idle, see $dir/slurmctld.log and $dir/slurmd.log"
  echo "export SLURM_CONF=$SLURM_CONF"
}

queue_is_empty() { [ -z "$(squeue --noheader --me)" ]; }

# By the numbers in our own files, and only while these are still the programs that we started.
stop_one() {
  local dir="$1" name="$2" pid
  pid="$(cat "$dir/$name.pid" 2>/dev/null)" || return 0
  [ "$(cat "/proc/$pid/comm" 2>/dev/null)" = "$name" ] || return 0
  kill "$pid" 2>/dev/null || true
  wait_for 50 sh -c "! kill -0 $pid" || kill -9 "$pid" 2>/dev/null || true
}

stop() {
  local dir="$1"
  dir="$(cd "$dir" && pwd)" || die "$1: no such folder"
  export SLURM_CONF="$dir/slurm.conf"
  timeout 20 scancel --me >/dev/null 2>&1 || true
  wait_for 50 queue_is_empty || true
  for name in slurmd slurmctld munged; do stop_one "$dir" "$name"; done
  rm -f "$dir/munge.sock" "$dir"/*.pid
}

case "${1:-}" in
  check) have_slurm ;;
  start | stop)
    [ $# -eq 2 ] || die "$1 needs a folder; see scripts/slurm_local.sh --help"
    "$1" "$2"
    ;;
  *) die "expected start, stop or check; see scripts/slurm_local.sh --help" ;;
esac
