# Sourced: a Slurm of one machine (munged, slurmctld, slurmd) in a folder of its own, for a test.
# start_cluster FOLDER starts it and sets SLURM_CONF; stop_cluster ends what was started.

cluster_ids=()

# can_run_cluster: says why not, where it cannot.
can_run_cluster() {
  local name
  for name in munged slurmctld slurmd sbatch squeue; do
    PATH=$PATH:/usr/sbin command -v "$name" >/dev/null || { echo "$name is not installed"; return 1; }
  done
  [ "$(id -u)" -eq 0 ] || { echo "slurmd needs root"; return 1; }
}

free_port() { python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'; }

# in_background LOG COMMAND...: starts a daemon in the foreground of its own.
in_background() {
  local log=$1
  shift
  "$@" >"$log" 2>&1 &
  cluster_ids+=($!)
}

start_cluster() {
  local folder=$1 host
  host=$(hostname -s)
  export PATH=$PATH:/usr/sbin SLURM_CONF=$folder/slurm.conf
  mkdir -p "$folder"/{state,spool,munge}
  chmod 0700 "$folder/munge"
  head -c 1024 /dev/urandom >"$folder/munge/key"
  chmod 0400 "$folder/munge/key"
  cat >"$SLURM_CONF" <<CONF
ClusterName=fenestra
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
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
  in_background "$folder/munged.log" munged --foreground --force --key-file="$folder/munge/key" \
    --socket="$folder/munge/socket" --pid-file="$folder/munge/pid" --log-file="$folder/munge/log" \
    --seed-file="$folder/munge/seed" --num-threads=2
  until [ -S "$folder/munge/socket" ]; do
    kill -0 "${cluster_ids[-1]}" || { cat "$folder/munged.log"; return 1; }
    sleep 0.1
  done
  in_background "$folder/slurmctld.log" slurmctld -D
  in_background "$folder/slurmd.log" slurmd -D
  local tries
  for tries in $(seq 300); do
    [ "$(sinfo --noheader --format=%T 2>/dev/null)" != idle ] || return 0
    sleep 0.1
  done
  tail -n 20 "$folder"/*.log
  return 1
}

# wait_for_jobs SECONDS: until the queue is empty.
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
  for ((i = ${#cluster_ids[@]} - 1; i >= 0; --i)); do
    kill "${cluster_ids[i]}" 2>/dev/null || true
    wait "${cluster_ids[i]}" 2>/dev/null || true
  done
  cluster_ids=()
}
