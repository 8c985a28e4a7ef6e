#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
#
# run_resume.sh SCENE.prm ALVEOLUS WORK_DIR [LAUNCHER FOR TWO PROCESSES...]
#
# Runs a scene, disturbs it in every way a run left alone can be disturbed, and
# resumes it: the history must equal that of the undisturbed run. In the
# environment: ALVEOLUS_KILLS (default 8) is how often the run is killed in all,
# ALVEOLUS_SEED the seed of the random moments.
set -euo pipefail

scene=$1 program=$2 work=$3
shift 3
launcher=("$@")
kills=${ALVEOLUS_KILLS:-8}
seed=${ALVEOLUS_SEED:-$RANDOM}
RANDOM=$seed
echo "ALVEOLUS_SEED=$seed"

scene=$(realpath "$scene")
cd "$(dirname "$0")/../.."
rm -rf "$work"
mkdir -p "$work"

fail() { echo "FAILED: $*" >&2; exit 1; }
run() { "$program" --quiet --threads 1 "$@"; }
# For the background, where $! is to be the program itself
run_there() { exec "$program" --quiet --threads 1 "$@"; }
start_there() # FOLDER: a checkpoint after each step
{
  run_there --output "$1" --set 'Checkpoint/Step interval=1' "$scene"
}

# Columns without wall times
columns()
{
  awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i !~ /\[s\]/) at[++n] = i }
           { for (i = 1; i <= n; ++i)
               printf "%s%s", $at[i], (i < n ? "," : "\n") }' "$1"
}
same() # FOLDER: to the last digit
{
  cmp <(columns "$work/full/history.csv") <(columns "$1/history.csv") ||
    fail "the history in $1 differs"
  [[ ! -e $work/full/remeshes.csv ]] ||
    cmp <(columns "$work/full/remeshes.csv") <(columns "$1/remeshes.csv") ||
    fail "remeshes.csv in $1 differs"
  # Fields: the same times, and every file that is named is there
  cmp <(grep '<DataSet' "$work/full/fields.pvd") \
    <(grep '<DataSet' "$1/fields.pvd") || fail "fields.pvd in $1 differs"
  local file
  while IFS= read -r file; do
    [[ $(tail -n 1 "$1/$file") == '</VTKFile>' ]] ||
      fail "$1/$file is not complete"
  done < <(sed -n 's/.*file="\([^"]*\)".*/\1/p' "$1/fields.pvd")
  # Nothing unfinished is left, and the last checkpoints are
  [[ -z $(find "$1" -name '*.unfinished') ]] || fail "unfinished files in $1"
  [[ $(find "$1/checkpoint" -name '*.alv' | wc -l) == 2 ]] ||
    fail "there are not two checkpoints in $1"
}
close() # FOLDER: within 1e-9 of the largest value of a column, or of the mass
{
  awk -F, '
    function abs(x) { return x < 0 ? -x : x }
    FNR == 1 { ++file; n = NF; for (i = 1; i <= n; ++i) name[i] = $i; next }
    file == 1 {
      ++rows
      for (i = 1; i <= n; ++i) {
        value[FNR, i] = $i
        k = name[i] ~ /\[mg\]/ ? "mass" : i
        if (abs($i) > size[k]) size[k] = abs($i)
      }
      next
    }
    {
      ++others
      for (i = 1; i <= n; ++i) {
        k = name[i] ~ /\[mg\]/ ? "mass" : i
        scale = size[k] > 1e-3 ? size[k] : 1e-3
        d = abs($i - value[FNR, i]) / scale
        if (d > worst) { worst = d; where = name[i] }
      }
    }
    END {
      print "largest difference " worst " (" where ")"
      exit !(rows == others && rows > 0 && worst <= 1e-9)
    }' <(columns "$work/full/history.csv") <(columns "$1/history.csv") ||
    fail "the history in $1 differs"
}
reason() { sed -n 's/^  "reason": "\(.*\)",*$/\1/p' "$1/summary.json"; }
# The exit code of a command, whose messages go to a file
code() { local c=0; "$@" >"$work/said" 2>&1 || c=$?; echo $c; }
expect() # CODE PATTERN COMMAND...
{
  local wanted=$1 pattern=$2 found
  shift 2
  found=$(code "$@")
  [[ $found == "$wanted" ]] || {
    cat "$work/said"
    fail "exit code $found instead of $wanted: $*"
  }
  [[ -z $pattern ]] || grep -Eq -e "$pattern" "$work/said" || {
    cat "$work/said"
    fail "no message with '$pattern': $*"
  }
}

# Processor time of a process and of its children that have ended, in ticks of
# 10 ms; nothing if it is no more. A busy machine does not move what is placed by
# it.
ticks() # PROCESS
{
  awk '{ sub(/.*\) /, ""); if ($1 != "Z") print $12 + $13 + $14 + $15 }' \
    "/proc/$1/stat" 2>/dev/null
}

# Undisturbed, and without checkpoints: they must not change results
run_there --output "$work/full" --set Checkpoint/Write=false "$scene" &
process=$!
duration=0
while now=$(ticks $process) && [[ -n $now ]]; do
  duration=$((now > duration ? now : duration))
  sleep 0.02
done
wait $process || fail "the undisturbed run ended with exit code $?"
rows=$(($(wc -l <"$work/full/history.csv") - 1))
echo "$rows rows in $duration ticks of processor time"
[[ ! -e $work/full/checkpoint ]] || fail "checkpoints although they are off"

# kill -9 at random moments, until the run gets through
n=0 round=0
while ((n < kills)); do
  folder=$work/killed
  rm -rf "$folder"
  first=1
  while :; do
    if ((first)); then
      start_there "$folder" &
    elif compgen -G "$folder/checkpoint/*.alv" >/dev/null; then
      run_there --resume "$folder" &
    else # killed before there was one
      start_there "$folder" &
    fi
    first=0
    process=$!
    if ((n < kills)); then
      # From within the start of the program to near its end; a little later,
      # since no time passes for it while it waits for the mesher.
      moment=$(((5 + 110 * RANDOM / 32768) * duration / 100))
      while now=$(ticks $process) && [[ -n $now ]] && ((now < moment)); do
        sleep 0.01
      done
      sleep "0.$(printf %03d $((RANDOM % 300)))"
      if [[ -n $(ticks $process) ]] && kill -9 $process; then
        n=$((n + 1))
        last=$(tail -n 1 "$folder/log.txt" 2>/dev/null || true)
        echo "kill $n: ${last:0:70}"
      fi
    fi
    if wait $process 2>/dev/null; then
      break
    fi
  done
  round=$((round + 1))
  same "$folder"
done
echo "killed $n times in $round runs, all resumed"

# SIGTERM: the step is finished, everything saved
folder=$work/terminated
start_there "$folder" &
process=$!
until [[ -e $folder/history.csv && $(wc -l <"$folder/history.csv") -gt 3 ]]; do
  sleep 0.02
  kill -0 $process || fail "the run has ended before it could be interrupted"
done
# Nobody else may write there meanwhile.
kill -STOP $process
expect 2 'another run is writing' run --resume "$folder"
kill -TERM $process
kill -CONT $process
c=0
wait $process || c=$?
[[ $c == 1 ]] || fail "exit code $c after SIGTERM"
[[ $(reason "$folder") == "interrupted by SIGTERM at t = "* ]] ||
  fail "reason: $(reason "$folder")"
(($(wc -l <"$folder/history.csv") - 1 < rows)) || fail "SIGTERM came too late"
cp -r "$folder" "$work/damaged"
cp -r "$folder" "$work/parallel"
cp -r "$folder" "$work/changed"
run --resume "$folder"
same "$folder"

# Changed settings are named
expect 2 "Solver / Tolerance: was '.*', is '1e-7'" \
  run --resume "$work/changed" --set Solver/Tolerance=1e-7
expect 2 'Time / End: was' \
  run --resume "$work/changed" --set Time/End=1000 "$scene"
expect 0 '' run --resume "$work/changed" --set Solver/Tolerance=1e-7 \
  --accept-changes

# A damaged checkpoint is named with its block, the older one is offered
mapfile -t files < <(find "$work/damaged/checkpoint" -name '*.alv' | sort)
size=$(stat -c %s "${files[1]}")
printf 'X' | dd of="${files[1]}" bs=1 seek=$((size / 2)) conv=notrunc 2>/dev/null
expect 2 "${files[1]}: .*block .*--resume ${files[0]}" \
  run --resume "$work/damaged"
truncate -s $((size / 3)) "${files[1]}"
expect 2 "${files[1]}: the file ends .*--resume ${files[0]}" \
  run --resume "$work/damaged"
run --resume "${files[0]}"
same "$work/damaged"
expect 2 "there is no checkpoint in" run --resume "$work"

# A full disk: here one that from some moment on takes no file larger than 64 kB
# (a checkpoint is). MPI needs larger ones when it starts.
folder=$work/full-disk
start_there "$folder" &
process=$!
until [[ -e $folder/history.csv && $(wc -l <"$folder/history.csv") -gt 3 ]]; do
  sleep 0.02
done
kill -STOP $process
prlimit --pid $process --fsize=65536
kill -CONT $process
c=0
wait $process || c=$?
[[ $c == 1 ]] || fail "exit code $c with a full disk"
[[ $(reason "$folder") == *"File too large"* ]] || fail "$(reason "$folder")"
(($(wc -l <"$folder/history.csv") - 1 < rows)) || fail "the limit came too late"
run --resume "$folder"
same "$folder"

# The same on a small file system, where one can be mounted
if unshare -rm true 2>/dev/null; then
  mkdir -p "$work/small"
  expect 1 '' unshare -rm bash -c '
    set -e
    folder=$1 kept=$2
    shift 2
    mount -t tmpfs -o size=300k none "$folder"
    c=0
    "$@" || c=$?
    cp -r "$folder" "$kept"
    exit $c' -- "$work/small" "$work/small-kept" "$program" --quiet \
    --threads 1 --output "$work/small/output" \
    --set 'Checkpoint/Step interval=1' "$scene"
  [[ -z $(find "$work/small-kept" -name '*.unfinished') ]] ||
    fail "unfinished files on the full disk"
  grep -q 'No space left' "$work/said" "$work/small-kept/output/summary.json" ||
    fail "the full disk is not mentioned"
  # What the disk still took is whole.
  if compgen -G "$work/small-kept/output/checkpoint/*.alv" >/dev/null; then
    run --resume "$work/small-kept/output"
    [[ $(find "$work/small-kept" -name '*.alv' | wc -l) == 2 ]] ||
      fail "no checkpoints after the full disk"
    cmp <(columns "$work/full/history.csv") \
      <(columns "$work/small-kept/output/history.csv") ||
      fail "the history after the full disk differs"
  fi
else
  echo "SKIPPED: no file system can be mounted here"
fi

# The output folder vanishes
folder=$work/vanished
start_there "$folder" 2>"$work/vanished.said" &
process=$!
until [[ -e $folder/history.csv && $(wc -l <"$folder/history.csv") -gt 2 ]]; do
  sleep 0.02
done
mv "$folder" "$folder-elsewhere"
c=0
wait $process || c=$?
[[ $c == 1 ]] || fail "exit code $c after the folder had vanished"
grep -q 'has the folder vanished\|No such file' "$work/vanished.said" ||
  fail "$(cat "$work/vanished.said")"
run --resume "$folder-elsewhere"
same "$folder-elsewhere"

# From one process to two and back
if ((${#launcher[@]})); then
  "${launcher[@]}" "$program" --quiet --threads 1 --resume "$work/parallel"
  close "$work/parallel"
  folder=$work/parallel-first
  # Only the processes get the signal: a launcher may kill them soon after.
  "${launcher[@]}" bash -c 'echo $$ >>"$1"; shift; exec "$@"' -- \
    "$work/processes" "$program" --quiet --threads 1 --output "$folder" \
    --set 'Checkpoint/Step interval=1' "$scene" &
  process=$!
  until [[ -e $folder/history.csv && $(wc -l <"$folder/history.csv") -gt 3 ]]; do
    sleep 0.02
  done
  kill -TERM $(tail -n 1 "$work/processes")
  wait $process && fail "an interrupted parallel run ended with 0"
  [[ $(reason "$folder") == "interrupted by SIGTERM at t = "* ]] ||
    fail "reason: $(reason "$folder")"
  run --resume "$folder"
  close "$folder"
fi
echo "every disturbed run went on to the same end"
