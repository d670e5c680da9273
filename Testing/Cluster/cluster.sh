# For sourcing: a single-node Slurm cluster (munged, slurmctld, slurmd) in the folder of a test.
# begin_test FENESTRA FOLDER empties and enters the folder, or skips the test without Slurm; start_cluster
# starts the daemons and sets SLURM_CONF. The daemons end with the test.

daemon_ids=()

# can_run_cluster: status 1 and a reason if Slurm cannot run here.
can_run_cluster() {
  local name
  for name in munged slurmctld slurmd sbatch squeue; do
    PATH=$PATH:/usr/sbin command -v "$name" >/dev/null || { echo "$name is not installed"; return 1; }
  done
  [ "$(id -u)" -eq 0 ] || { echo "slurmd needs root"; return 1; }
}

fail() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

skip() {
  printf 'SKIPPED: %s\n' "$*"
  exit 77
}

begin_test() {
  local why
  why=$(can_run_cluster) || skip "$why"
  export FENESTRA
  FENESTRA=$(realpath "$1")
  rm -rf "$2"
  mkdir -p "$2"
  cd "$2"
  trap stop_cluster EXIT
}

# print_jobs: prints the log of slurmctld about the jobs, and their output.
print_jobs() {
  local log
  printf -- '-- jobs, from the log of slurmctld\n'
  grep -oE '\<(JobId|Name|JobState|StartTime|EndTime|NodeList|ArrayJobId|ArrayTaskId|ExitCode)=[^ ]+' \
    slurm/jobs.log | tr '\n' ' ' | sed 's/ JobId/\nJobId/g; s/ $/\n/'
  for log in fenestra-*.log; do
    printf '\n-- %s\n' "$log"
    cat "$log"
  done
}

find_free_port() { python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'; }

# start_daemon LOG COMMAND...: starts a daemon, which stop_cluster ends.
start_daemon() {
  local log=$1
  shift
  "$@" >"$log" 2>&1 &
  daemon_ids+=($!)
}

start_cluster() {
  local folder=$PWD/slurm host
  host=$(hostname -s)
  export PATH=$PATH:/usr/sbin SLURM_CONF=$folder/slurm.conf
  mkdir -p "$folder"/{state,spool,munge}
  chmod 0700 "$folder/munge"
  head -c 1024 /dev/urandom >"$folder/munge/key"
  chmod 0400 "$folder/munge/key"
  cat >"$SLURM_CONF" <<CONF
ClusterName=fenestra
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$(find_free_port)
SlurmdPort=$(find_free_port)
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket
CredType=cred/munge
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/filetxt
JobCompLoc=$folder/jobs.log
SchedulerParameters=bf_interval=2,sched_interval=2
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
  start_daemon "$folder/munged.log" munged --foreground --force --key-file="$folder/munge/key" \
    --socket="$folder/munge/socket" --pid-file="$folder/munge/pid" --log-file="$folder/munge/log" \
    --seed-file="$folder/munge/seed" --num-threads=2
  until [ -S "$folder/munge/socket" ]; do
    kill -0 "${daemon_ids[-1]}" || { cat "$folder/munged.log"; return 1; }
    sleep 0.1
  done
  start_daemon "$folder/slurmctld.log" slurmctld -D
  start_daemon "$folder/slurmd.log" slurmd -D
  local tries
  for tries in $(seq 300); do
    [ "$(sinfo --noheader --format=%T 2>/dev/null)" != idle ] || return 0
    sleep 0.1
  done
  tail -n 20 "$folder"/*.log
  return 1
}

# wait_for_jobs SECONDS: waits until the queue is empty; status 1 after SECONDS.
wait_for_jobs() {
  local tries
  for tries in $(seq $((2 * $1))); do
    [ -n "$(squeue --noheader 2>&1)" ] || return 0
    sleep 0.5
  done
  squeue
  return 1
}

stop_cluster() {
  local i
  for ((i = ${#daemon_ids[@]} - 1; i >= 0; --i)); do
    kill "${daemon_ids[i]}" 2>/dev/null || true
    wait "${daemon_ids[i]}" 2>/dev/null || true
  done
  daemon_ids=()
}
