#!/bin/bash
# Commands of Slurm that run tasks as processes of this machine, for tests: linked as sbatch, squeue,
# scancel and scontrol, and, called as fake_slurm.sh, what starts the tasks. $FAKE_SLURM holds
#   jobs/ID/{name,script,folder,output}   what was submitted
#   queue/ID_INDEX                        state of a task: PENDING or RUNNING
#   pids/ID_INDEX                         its process group
#   refuse                                how many submissions are refused from now on
#   requeue                               there: a task that is killed (signal 9) is run again
#   hold                                  there: such a task is held instead, as one is that was
#                                         requeued max_batch_requeue times
#   stop                                  there: the end
set -u
shopt -s nullglob
cd "$FAKE_SLURM"

# The first line of a file in $line, empty where there is none; without a process, since the server
# asks twenty times a second.
look() {
  line=
  { read -r line <"$1"; } 2>/dev/null
}

set_state() {
  echo "$2" >"new.$1.$BASHPID"
  mv "new.$1.$BASHPID" "queue/$1"
}

run_task() {
  local task=$1 job=${1%_*} code
  (
    cd "$(cat "jobs/$job/folder")" || exit 1
    output=$(cat "$FAKE_SLURM/jobs/$job/output")
    output=${output//%a/${task#*_}}
    SLURM_ARRAY_TASK_ID=${task#*_} exec setsid "$(cat "$FAKE_SLURM/jobs/$job/script")" \
      >>"${output//%%/%}" 2>&1
  ) &
  echo $! >"pids/$task"
  wait $!
  code=$?
  rm -f "pids/$task"
  if ((code == 137)) && [[ -e hold ]]; then
    set_state "$task" REQUEUE_HOLD
  elif ((code == 137)) && [[ -e requeue ]]; then
    set_state "$task" PENDING
  else
    rm -f "queue/$task"
  fi
}

serve() {
  mkdir -p jobs queue pids
  local silent
  exec {silent}<> <(:)  # nobody writes into it: a pause without a process
  while [[ ! -e stop ]]; do
    local running=0 task
    for task in queue/*; do look "$task" && [[ $line == RUNNING ]] && ((++running)); done
    for task in queue/*; do
      ((running < 2)) || break
      look "$task" && [[ $line == PENDING ]] || continue
      set_state "${task#queue/}" RUNNING
      run_task "${task#queue/}" &
      ((++running))
    done
    read -rt 0.05 -u "$silent"
  done
  rm -f requeue
  for task in pids/*; do kill -9 -- "-$(cat "$task")" 2>/dev/null; done
  wait
}

submit() {
  local job name= folder= output= array= script= argument index
  echo "$*" >>submitted
  local refusals
  refusals=$(cat refuse 2>/dev/null || echo 0)
  if ((refusals > 0)); then
    echo $((refusals - 1)) >refuse
    echo 'sbatch: error: Slurm temporarily unable to accept job, sleeping and retrying.' >&2
    exit 1
  fi
  for argument in "$@"; do
    case $argument in
      --job-name=*) name=${argument#*=} ;;
      --chdir=*) folder=${argument#*=} ;;
      --output=*) output=${argument#*=} ;;
      --array=*) array=${argument#*=} ;;
      --partition=nowhere)
        echo 'sbatch: error: Batch job submission failed: Invalid partition name specified' >&2
        exit 1
        ;;
      --*) ;;
      *) script=$argument ;;
    esac
  done
  job=$(($(ls jobs | wc -l) + 1))
  mkdir -p "jobs/$job"
  echo "$name" >"jobs/$job/name"
  echo "$folder" >"jobs/$job/folder"
  echo "$output" >"jobs/$job/output"
  cp "$script" "jobs/$job/copy"  # Slurm runs the script as it was submitted
  chmod +x "jobs/$job/copy"
  echo "$FAKE_SLURM/jobs/$job/copy" >"jobs/$job/script"
  for range in ${array//,/ }; do
    range=${range%\%*}
    for ((index = ${range%-*}; index <= ${range#*-}; ++index)); do
      set_state "${job}_$index" PENDING
    done
  done
  echo "$job"
}

list() {
  local name= argument task state
  for argument in "$@"; do [[ $argument == --name=* ]] && name=${argument#*=}; done
  for task in queue/*; do
    look "$task" || continue
    state=$line task=${task#queue/}
    look "jobs/${task%_*}/name"
    [[ $line == "$name" ]] || continue
    case $state in
      PENDING) echo "$task|$state|Resources" ;;
      REQUEUE_HOLD) echo "$task|$state|JobHoldMaxRequeue" ;;
      *) echo "$task|$state|None" ;;
    esac
  done
}

cancel() {
  local job task
  for job in "$@"; do
    for task in queue/"${job}" queue/"${job}"_*; do
      task=${task#queue/}
      [[ $(cat "queue/$task" 2>/dev/null) == @(PENDING|REQUEUE_HOLD) ]] && rm -f "queue/$task"
      [[ -e pids/$task ]] && kill -TERM -- "-$(cat "pids/$task")" 2>/dev/null
    done
  done
  echo "$*" >>cancelled
}

case ${0##*/} in
  sbatch) submit "$@" ;;
  squeue) list "$@" ;;
  scancel) cancel "$@" ;;
  scontrol) echo "MaxArraySize            = ${FAKE_MAX_ARRAY_SIZE:-4}" ;;
  *) serve ;;
esac
exit 0
