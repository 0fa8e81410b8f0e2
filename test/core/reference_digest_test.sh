#!/usr/bin/env bash
# The reference runs give the digests that are written down, whoever compiled them.
# usage: reference_digest_test.sh EXPECTED PROGRAM...
set -euo pipefail
expected=$1
shift
failed=0
for program in "$@"; do
  if ! difference=$(diff --label written --label computed -U0 "$expected" <("$program")); then
    printf '%s\n%s\n' "$(basename "$program") gives other bits than those written in $(basename "$expected"):" \
      "$difference"
    failed=1
  fi
done
if [[ $failed -ne 0 ]]; then
  echo "If all programs agree with each other, the core's arithmetic was changed: recordings made before differ from" \
    "then on. If that is meant, scripts/platforms --digests --accept writes the new digests down."
fi
exit $failed
