#!/usr/bin/env bash
# What a function compiled for fused multiply-add calls must be inlined into it, or have such a version too: or else it
# runs the version for older machines, where each fused multiply-add is a call of the C library.
set -euo pipefail

# the caller, and what it calls, of every call in the archive
calls=$(objdump --reloc --disassemble "$1" |
        awk '/^[0-9a-f]+ <.*>:$/ { caller = substr($2, 2, length($2) - 3) }
             /R_X86_64_(PLT32|PC32|GOTPCREL)/ { called = $NF; sub(/[-+]0x[0-9a-f]+$/, "", called); print caller, called }' |
        sort -u)
hot=$(awk '$1 ~ /\.fma/' <<<"$calls")
[[ -n $hot ]] || { echo "$1 has no function compiled for fused multiply-add"; exit 1; }
slow=$(awk '$2 == "fma" { print $1 }' <<<"$calls" | grep -v '\.' || true)
found=$(awk 'NR == FNR { slow[$1] = 1; next } $2 == "fma" || $2 in slow' <(printf '%s\n' "${slow:-none}") <(printf '%s\n' "$hot"))
[[ -z $found ]] || { c++filt <<<"$found" | sed 's/^/not inlined: /'; exit 1; }
