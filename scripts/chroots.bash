# Sourced by scripts/platforms: roots of other systems, made by debootstrap, and commands in them. Nothing of the machine's
# own tree is mounted into a root, and what is mounted goes with the process that mounted it (a mount namespace).
# shellcheck disable=SC2154  # afm_root, of environment.bash
# shellcheck disable=SC2034  # chroot_tree, used where this is sourced

afm_cache=${AFM_PLATFORMS_DIR:-/var/cache/afm_platforms}
chroot_tree=/srv/afm_emulator

chroot_mirrors=()

# the repositories in the machine's own apt settings, and those that were asked for, one a line
mirrors() {
  printf '%s\n' "${chroot_mirrors[@]}"
  cat /etc/apt/sources.list /etc/apt/sources.list.d/*.list /etc/apt/sources.list.d/*.sources 2>/dev/null |
    sed -nE 's/^deb +(\[[^]]*\] *)?([^ ]+).*/\2/p; s/^URIs: *//p' | tr ' ' '\n' | sort -u
}

# usage: mirror_of SUITE; the first mirror that has it
mirror_of() {
  local uri
  for uri in $(mirrors); do
    if apt_can_get "${uri%/}/dists/$1/InRelease"; then
      echo "${uri%/}"
      return
    fi
  done
  return 1
}

# by apt's own method, so that its proxy and its settings count
apt_can_get() {
  local file
  file=$(mktemp)
  /usr/lib/apt/apt-helper -q download-file "$1" "$file" >/dev/null 2>&1
  local status=$?
  rm -f "$file"
  return $status
}

# usage: is_foreign ARCHITECTURE
is_foreign() { [[ $1 != "$(dpkg --print-architecture)" ]]; }

# usage: runs_here ARCHITECTURE; of itself, or by a qemu that the kernel knows and that is there in any root
runs_here() {
  is_foreign "$1" || return 0
  [[ $1 == arm64 ]] && grep -qsx enabled /proc/sys/fs/binfmt_misc/qemu-aarch64 &&
    grep -qsx 'flags:.*F.*' /proc/sys/fs/binfmt_misc/qemu-aarch64
}

# usage: make_root NAME SUITE ARCHITECTURE; does nothing where the root is there
make_root() {
  local root=$afm_cache/$1 suite=$2 architecture=$3 mirror
  [[ ! -d $root ]] || return 0
  mirror=$(mirror_of "$suite") || { echo "no mirror of this machine has $suite" >&2; return 1; }
  mkdir -p "$afm_cache"
  rm -rf --one-file-system "$root.unfinished"
  debootstrap --variant=minbase --arch="$architecture" "$suite" "$root.unfinished" "$mirror" || return
  # without security updates: a mirror may list more of them than it has
  echo "deb $mirror $suite main" >"$root.unfinished/etc/apt/sources.list"
  echo force-unsafe-io >"$root.unfinished/etc/dpkg/dpkg.cfg.d/unsafe-io"  # it can be made again
  # how this machine reaches its mirror
  grep -lsE '^ *Acquire::(http|Check|Retries|Force)' /etc/apt/apt.conf /etc/apt/apt.conf.d/* |
    xargs -r cp -t "$root.unfinished/etc/apt/apt.conf.d"
  mv "$root.unfinished" "$root"
}

# usage: in_root NAME COMMAND [ARGUMENT...]
# With processes and mounts of its own, which end with this shell; with $isolated=yes also with a loopback of its own and no other network.
in_root() {
  local root=$afm_cache/$1 namespaces=(--mount --pid --fork --kill-child)
  shift
  [[ ${isolated:-no} == no ]] || namespaces+=(--net)
  cp /etc/resolv.conf /etc/hosts "$root/etc/"
  # shellcheck disable=SC2016  # for the shell in the namespaces
  setpriv --pdeathsig KILL unshare "${namespaces[@]}" bash -c '
    set -e
    root=$1; shift
    mount -t proc proc "$root/proc"
    mount -t sysfs -o ro sysfs "$root/sys"
    mount -t devpts -o newinstance,ptmxmode=666 devpts "$root/dev/pts"
    mount -t tmpfs tmpfs "$root/dev/shm"
    [[ ${isolated:-no} == no ]] || ip link set lo up
    exec env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 chroot "$root" "$@"
  ' in_root "$root" "$@"
}

install_in_root() {  # after an installation that was interrupted, too
  in_root "$1" env DEBIAN_FRONTEND=noninteractive sh -c \
    'dpkg --configure -a && apt-get update && apt-get install --yes --no-install-recommends "$@"' sh "${@:2}"
}

# usage: copy_tree NAME COMMIT; a clone, in which only what changed is written, so that builds go on from the last
copy_tree() {
  local tree=$afm_cache/$1$chroot_tree
  [[ -d $tree/.git ]] || git clone --quiet --no-local --no-checkout "$afm_root" "$tree"
  git -C "$tree" fetch --quiet "$afm_root" "$2"
  git -C "$tree" checkout --quiet --force --detach "$2"
}
