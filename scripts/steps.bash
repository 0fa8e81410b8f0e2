# Sourced by scripts/run: long commands that show how far they are.

# The last line of a log, overwritten as it changes, until this process is killed or the script that began it has ended.
# While the log does not grow nothing is printed, so that a question for a password stays.
show_last_line() {
  local text=$1 log=$2 line shown=
  while kill -0 $$ 2>/dev/null; do
    line=$(tail -c 400 "$log" 2>/dev/null | tr '\r' '\n' | tail -n 1)
    if [[ -n $line && $line != "$shown" ]]; then
      shown=$line
      printf '\r%.*s\e[K' $(($(tput cols 2>/dev/null || echo 80) - 1)) "$text: $line"
    fi
    sleep 0.2
  done
}

# usage: step TEXT LOG COMMAND...
# Runs the command with its output in the log, and says what it is at. Fails as the command fails, with the end of the
# log.
step() {
  local text=$1 log=$2 begin=$SECONDS watcher status=0
  shift 2
  mkdir -p "$(dirname "$log")"
  : >"$log"
  if [[ -t 1 ]]; then
    show_last_line "$text" "$log" &
    watcher=$!
  else
    echo "$text"
  fi
  "$@" >"$log" 2>&1 || status=$?
  if [[ -n ${watcher:-} ]]; then
    kill "$watcher" 2>/dev/null || true
    wait "$watcher" 2>/dev/null || true
    printf '\r\e[K%s: %d s\n' "${text% (*}" $((SECONDS - begin))
  fi
  if [[ $status -ne 0 ]]; then
    tail -n 30 "$log" >&2
    echo "the step above failed; its whole output is in $log" >&2
  fi
  return "$status"
}
