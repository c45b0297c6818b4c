#!/usr/bin/env bash
# The first hour of a newcomer, repeated: an empty Debian 12 in a folder, a copy of this tree, and ./run in it.
#   scripts/try_bare_debian.sh <folder> [<argument of ./run>...]     as root, with debootstrap installed
# Without further arguments, ./run test and then ./run. The mirror is the one this system uses (MIRROR overrides it), and
# so are apt's settings and keys. The folder is kept: a second call starts from where the first one stopped.
set -euo pipefail

if [ $# -lt 1 ] || [ "$(id -u)" != 0 ] || ! command -v debootstrap >/dev/null; then
  echo "usage, as root and with debootstrap installed: $0 <folder> [<argument of ./run>...]"
  exit 2
fi
mkdir -p "$1"
folder=$(cd "$1" && pwd)
shift
tree=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# The first Debian mirror apt knows, whatever the format of its list.
mirror=${MIRROR:-$(grep -rhoE '^(URIs:|deb) .*' /etc/apt/sources.list /etc/apt/sources.list.d 2>/dev/null |
  grep -oE '[a-z+]+://[^ ]*/debian/?( |$)' | sed -n '1s/ *$//p' || true)}

if [ ! -e "$folder/bare" ]; then
  debootstrap --variant=minbase bookworm "$folder" "$mirror"
  # Settings and keys of this system, and none of its other sources.
  cp -a /etc/apt/apt.conf.d/. "$folder/etc/apt/apt.conf.d/"
  cp -a /usr/share/keyrings/. "$folder/usr/share/keyrings/" 2>/dev/null || true
  if [ -e /etc/apt/sources.list.d/debian.sources ]; then
    rm -f "$folder/etc/apt/sources.list"
    cp /etc/apt/sources.list.d/debian.sources "$folder/etc/apt/sources.list.d/"
  fi
  for file in /etc/apt/apt.conf /etc/apt/auth.conf /etc/resolv.conf /etc/hosts; do
    [ ! -e "$file" ] || cp -L "$file" "$folder$file"
  done
  touch "$folder/bare"
fi

# The tree as git knows it, changes included, and nothing built; without git, all but build/ and out/.
mkdir -p "$folder/home/delassus"
if [ -e "$tree/.git" ]; then
  (cd "$tree" && git ls-files -z --cached --others --exclude-standard | tar --ignore-failed-read -cf - --null -T -)
else
  tar -cf - -C "$tree" --exclude=./build --exclude=./out .
fi | tar -xf - -C "$folder/home/delassus"

mountpoint -q "$folder/proc" || mount -t proc proc "$folder/proc"
trap 'umount "$folder/proc"' EXIT
inside() { env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root DELASSUS_JOBS="${DELASSUS_JOBS-}" \
  ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} \
  chroot "$folder" /home/delassus/run "$@"; }

if [ $# -gt 0 ]; then
  inside "$@"
else
  inside
  inside test
fi
