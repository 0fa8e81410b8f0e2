#!/usr/bin/env bash
# On a machine without AVX2 and fused multiply-add, and on one without AVX-512, the programs run and give the same bits.
# The machines are qemu's, slow where every fused multiply-add is done by hand: few runs are made.
# usage: older_machines_test.sh EXPECTED REFERENCE_DIGEST NEXT_IMPACT FRICTION_CURVE IMPACTS
set -euo pipefail
expected=$1 reference=$2 next_impact=$3 friction_curve=$4 impacts=$5
if ! command -v qemu-x86_64 >/dev/null; then
  echo "skipped: no qemu-x86_64 here (Debian: qemu-user)"
  exit 77
fi

failed=0
# expect_same WHAT EXPECTED COMPUTED
expect_same() {
  if ! difference=$(diff -U0 --label expected --label "$1" "$2" "$3"); then
    printf '%s\n%s\n' "$1: other bits" "$difference"
    failed=1
  fi
}
digests() { qemu-x86_64 -cpu "$1" "$reference" "${@:2}" 2>/dev/null; }
curve=(--eta 2:2.4:0.05 --duration 50 --transient 20)

expect_same "Haswell: all reference runs" "$expected" <(digests Haswell)
few=('eta 5 ' 'four at once')
expect_same "Nehalem: a few of them" <(grep -F "$(printf '%s\n' "${few[@]}")" "$expected") <(digests Nehalem "${few[@]}")
for machine in Nehalem Haswell; do
  expect_same "$machine: next_impact" <(cut -d, -f1-7 "$impacts" | "$next_impact") \
    <(cut -d, -f1-7 "$impacts" | qemu-x86_64 -cpu "$machine" "$next_impact" 2>/dev/null)
  expect_same "$machine: friction_curve" <("$friction_curve" "${curve[@]}") \
    <(qemu-x86_64 -cpu "$machine" "$friction_curve" "${curve[@]}" --threads 1 2>/dev/null)
done
exit $failed
