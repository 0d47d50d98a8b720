#!/usr/bin/env bash
# rilo bench --on slurm against a real Slurm on this machine: the tables of a local run, tasks that are killed, cancelled
# or out of time and submitted again, a failure that is listed, a driver that is killed or interrupted, data that change
# while tasks wait, a controller that does not answer. Exit code 77: no Slurm here.
set -euo pipefail
scripts="$1/scripts"
rilo="${RILO_BIN:?run this through ctest}"
PATH="$PATH:/usr/sbin:/sbin"
"$scripts/slurm_local.sh" check || { echo "skipped: no Slurm here (slurmctld, slurmd, slurm-client, munge)"; exit 77; }

work="$(mktemp -d)"
driver=""
controller=""
finish() {
  [ -z "$controller" ] || kill -CONT "$controller" || true
  [ -z "$driver" ] || kill -9 "$driver" 2>/dev/null || true
  "$scripts/slurm_local.sh" stop "$work/slurm" || true
  rm -rf "$work"
}
trap finish EXIT
fail() {
  echo "FAILED: $*" >&2
  tail -n 20 "$work"/*.err >&2 || true
  exit 1
}
# Short pauses: a task is to be seen while it runs, and some run for half a second.
wait_for() {
  for _ in $(seq 3000); do
    "$@" >/dev/null 2>&1 && return 0
    sleep 0.02
  done
  fail "waited in vain: $*"
}
# $work/bin comes before Slurm's own programs: says when one fails, and lets sbatch fail while no_sbatch is there.
watch_program() {
  cat >"$work/bin/$1" <<SH
#!/bin/sh
if [ $1 = sbatch ] && [ -e "$work/no_sbatch" ]; then code=1; else "$(command -v "$1")" "\$@"; code=\$?; fi
[ \$code -eq 0 ] || echo \$code >>"$work/$1.failures"
exit \$code
SH
  chmod +x "$work/bin/$1"
}
# Every process of the task of a cell; nothing when it does not run.
task_of() { pgrep -f -- "--out $work/$1 .*--cell $2\$"; }
# Again until no process of the task has come meanwhile: one that has just been started is about to start another.
stop_task() {
  local stopped="" now
  wait_for task_of "$1" "$2"
  now="$(task_of "$1" "$2" || true)"
  while [ "$now" != "$stopped" ]; do
    echo "$now" | xargs --no-run-if-empty kill -STOP || true
    stopped="$now"
    now="$(task_of "$1" "$2" || true)"
  done
  [ -n "$stopped" ] || fail "cell $2 of $1 ended before it could be stopped"
}
# Stopped first: a task that still runs may be finished before the signal, or scancel, reaches it.
kill_task() {
  stop_task "$1" "$2"
  task_of "$1" "$2" | head -n 1 | xargs kill -9
}
# How many tasks the cell has had.
tasks_had() { find "$work/$1/slurm" -name "*_$2.log" | wc -l; }
array_of() { squeue --noheader --me --array --format=%F_%K | grep "_$1\$"; }
same_tables() {
  diff <("$rilo" bench show "$work/local" --no-times) <("$rilo" bench show "$work/$1" --no-times) ||
    fail "the tables of $1 are not those of the local run"
}

RILO_SLURM_CPUS=2 "$scripts/slurm_local.sh" start "$work/slurm" >/dev/null
export SLURM_CONF="$work/slurm/slurm.conf"
"$rilo" simulate --out "$work/drive" --sensor vlp16 --start 10 --sweeps 24 --quiet
mkdir "$work/long"
for i in $(seq 0 59); do
  phase=$((i % 46))
  ln -s "$work/drive/velodyne/$(printf %06d $((phase < 24 ? phase : 46 - phase))).bin" "$work/long/$(printf %06d "$i").bin"
done
cat >"$work/plan.yaml" <<'YAML'
sequences:
  - { name: drive, path: drive }
  - { name: long, path: long }
configurations:
  - name: full
  - name: A
    set: [coarse.enabled=false]
YAML
# Ends the shell that calls it: start_bench … & is the command itself, whose number is $!.
start_bench() {
  local out="$1"
  shift
  exec "$rilo" bench "$work/plan.yaml" --threads 1 --out "$work/$out" "$@" >"$work/$out.out" 2>"$work/$out.err"
}
bench() { (start_bench "$@"); }
bench local --jobs 2

echo "== a plain run, two tasks at a time"
bench plain --on slurm --jobs 2 || fail "exit code $?"
same_tables plain

echo "== tasks that are killed, cancelled and out of time are submitted again"
# One at a time: the second would end while the first is being stopped.
start_bench broken --on slurm --jobs 1 --retries 1 &
driver=$!
kill_task broken 0
stop_task broken 1
scancel "$(array_of 1)"
stop_task broken 2
sleep 6  # the driver waits three seconds for the result of a task that failed
[ "$(tasks_had broken 0)" -eq 1 ] || fail "cell 0 was submitted again beside an array that has the one place"
scontrol update JobId="$(array_of 2)" EndTime="$(date -d '+1 second' +%Y-%m-%dT%H:%M:%S)"
wait "$driver" || fail "exit code $?"
driver=""
same_tables broken
grep -q "JobState=TIMEOUT" "$work/slurm/jobs.txt" || fail "no task ran out of time"
for cell in 0 1 2; do [ "$(tasks_had broken "$cell")" -eq 2 ] || fail "cell $cell was not submitted twice"; done
[ "$(tasks_had broken 3)" -eq 1 ] || fail "cell 3 was submitted again"

echo "== without retries the one that was killed is listed; the same command again runs it alone"
start_bench listed --on slurm &
driver=$!
kill_task listed 3
if wait "$driver"; then fail "a killed task went unnoticed"; fi
driver=""
grep -q "1 of 4 cells failed" "$work/listed.err" || fail "the failure is not said"
grep -q "failed: long × A: Slurm ended its task" "$work/listed.out" || fail "the failure is not listed"
bench listed --on slurm || fail "exit code $?"
same_tables listed
[ "$(tasks_had listed 0)" -eq 1 ] || fail "a finished cell was run again"

echo "== a driver that is killed: the tasks go on, the same command waits for them"
start_bench adopted --on slurm &
driver=$!
wait_for task_of adopted 2
kill -9 "$driver"
wait "$driver" 2>/dev/null || true
driver=""
bench adopted --on slurm || fail "exit code $?"
same_tables adopted
for cell in 0 1 2 3; do [ "$(tasks_had adopted "$cell")" -eq 1 ] || fail "cell $cell was submitted twice"; done

echo "== Ctrl-C: the tasks are cancelled, what is finished is kept"
start_bench interrupted --on slurm &
driver=$!
stop_task interrupted 2
kill -INT "$driver"
if wait "$driver"; then code=0; else code=$?; fi
driver=""
[ "$code" -eq 130 ] || fail "exit code $code"
queue_is_empty() { [ -z "$(squeue --noheader --me)" ]; }
wait_for queue_is_empty
bench interrupted --on slurm || fail "exit code $?"
same_tables interrupted

echo "== data that change while tasks wait: these refuse to run, and the table says why"
start_bench changed --on slurm --sbatch=--hold &
driver=$!
wait_for array_of 3
ln -s "$work/drive/velodyne/000000.bin" "$work/long/000060.bin"
scontrol release "$(squeue --noheader --me --format=%F | head -n 1)"
if wait "$driver"; then fail "changed data went unnoticed"; else code=$?; fi
driver=""
[ "$code" -eq 3 ] || fail "exit code $code"
grep -q "2 of 4 cells failed" "$work/changed.err" || fail "not the two cells of the changed data failed"
for cell in "long × full" "long × A"; do
  grep -q "failed: $cell: .*is not the one that was submitted: its data, .* Run the benchmark again" \
    "$work/changed.out" || fail "the reason is not listed: $cell"
done

echo "== a controller that does not answer, then takes no jobs: the driver asks again"
rm "$work/long/000060.bin"
mkdir "$work/bin"
watch_program squeue
watch_program sbatch
controller="$(cat "$work/slurm/slurmctld.pid")"
# Slurm's programs wait ten seconds for an answer unless told otherwise.
cp "$SLURM_CONF" "$work/slurm/impatient.conf"
echo "MessageTimeout=2" >>"$work/slurm/impatient.conf"
SLURM_CONF="$work/slurm/impatient.conf" PATH="$work/bin:$PATH" start_bench changed --on slurm --jobs 1 --retries 1 &
driver=$!
stop_task changed 2
kill -STOP "$controller"
wait_for test -s "$work/squeue.failures"
touch "$work/no_sbatch"
kill -CONT "$controller"
task_of changed 2 | xargs kill -9
wait_for test -s "$work/sbatch.failures"
rm "$work/no_sbatch"
wait "$driver" || fail "exit code $?"
driver=""
same_tables changed
[ "$(tasks_had changed 0)" -eq 1 ] || fail "a finished cell was run again"
[ "$(tasks_had changed 2)" -eq 3 ] || fail "cell 2 was not submitted again"
[ "$(tasks_had changed 3)" -eq 2 ] || fail "cell 3 was lost or submitted twice"
echo "all as expected"
