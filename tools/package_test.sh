#!/usr/bin/env bash
# Tries the packages of tools/package.sh in a new Debian 12, where neither the tree nor a compiler exists: counts the packages
# that they bring, uses the programs as another user from /, upgrades and removes all. Then it unpacks, moves and uses the
# archive. Needs root, debootstrap and a mirror of Debian. Takes ten minutes.
#   tools/package_test.sh PACKAGES FOLDER     FOLDER must not exist; it receives the system, and the test removes it
set -euo pipefail
packages="$(realpath "$1")" root="$(realpath -m "$2")"
[ ! -e "$root" ] || { echo "package_test: $root exists" >&2; exit 2; }
cleanup() {
  for mounted in proc dev/shm; do mountpoint -q "$root/$mounted" && umount "$root/$mounted"; done
  rm -rf --one-file-system "$root"
}
trap cleanup EXIT
debootstrap --variant=minbase bookworm "$root" >/dev/null
mount -t proc proc "$root/proc"
mount -t tmpfs tmpfs "$root/dev/shm"
inside() { chroot "$root" /usr/bin/env -i PATH=/usr/bin:/usr/sbin:/bin:/sbin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }
user() { inside setpriv --reuid 65534 --regid 65534 --clear-groups env HOME=/tmp/user XDG_RUNTIME_DIR=/tmp/user "$@"; }
mkdir -p "$root/packages" "$root/newer"
cp "$packages"/*.deb "$root/packages"
echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/fast" # nobody needs the system after a crash
inside apt-get update -qq

# count LIMIT PACKAGE...: packages that these bring, without those that are only recommended
count() {
  local limit="$1" brought
  brought="$(inside sh -c 'apt-get -s install --no-install-recommends "$@"' sh "${@:2}" | grep -c '^Inst')"
  echo "$brought packages with ${*:2}"
  [ "$brought" -le "$limit" ]
}
deb() { (cd "$root" && ls packages/"$1"_*.deb | sed 's|^|/|'); }
count 100 "$(deb psygen-game)" "$(deb psygen-data)"
count 100 "$(deb psygen-game)" "$(deb psygen-data)" mesa-vulkan-drivers
count 280 "$(deb psygen-game)" "$(deb psygen-data)" mesa-vulkan-drivers "$(deb psygen-pictures)"

# programs FOLDER GAMES_FOLDER: as another user, from /
programs() {
  rm -rf "$root/tmp/user"
  user mkdir -m 700 /tmp/user
  [ "$(user "$1/psygen" amplify --world paper --region 200,200,204,204 | grep -c '^hash')" -eq 1 ]
  user "$1/psygen" picture --world silver_combe --size 320x180 --out /tmp/user/combe.png
  user "$2/psygen-game" --headless --autoplay 5 --seed 7 --width 320 --height 180 --no-sound --picture /tmp/user/game.png
  user "$1/psygen-editor" --version
  (user xvfb-run -a -s "-screen 0 1280x800x24" sh -c "$1/psygen-editor ember_pass & editor=\$!
     sleep 40; import -window root /tmp/user/editor.png; kill \$editor; wait \$editor" || true) 2>/dev/null
  for picture in combe game editor; do
    [ "$(stat -c %s "$root/tmp/user/$picture.png")" -gt 20000 ] || { echo "$picture.png is empty"; exit 1; }
    [ -z "${KEEP_PICTURES:-}" ] || cp "$root/tmp/user/$picture.png" "$KEEP_PICTURES/${1//\//_}-$picture.png"
  done
}
inside apt-get install -y -qq --no-install-recommends mesa-vulkan-drivers xvfb xauth imagemagick zstd >/dev/null
inside sh -c 'apt-get install -y -qq --no-install-recommends /packages/*.deb' >/dev/null
programs /usr/bin /usr/games

# The next version: the same files under a later number.
for deb in "$root"/packages/*.deb; do
  dpkg-deb -R "$deb" "$root/newer/files"
  sed -i -E 's/^(Version: [0-9]+\.[0-9]+\.).*/\199/' "$root/newer/files/DEBIAN/control"
  dpkg-deb -Znone -b "$root/newer/files" "$root/newer" >/dev/null
  rm -rf "$root/newer/files"
done
inside sh -c 'apt-get install -y -qq --no-install-recommends /newer/*.deb' >/dev/null
[ "$(inside dpkg-query -W -f '${Version} ' 'psygen*' | tr ' ' '\n' | sed '/^$/d; s/.*\.//' | sort -u)" = 99 ]
user psygen --version
inside sh -c 'apt-get purge -y -qq "psygen*"' >/dev/null
left="$(find "$root/usr" "$root/etc" "$root/var/lib" -name '*psygen*')"
[ -z "$left" ] || { echo "left after removal: $left"; exit 1; }

# The archive, with the libraries that are still installed.
mkdir "$root/opt/first"
tar -C "$root/opt/first" -xf "$packages"/psygen-*.tar.zst
mv "$root"/opt/first/psygen-* "$root/opt/psygen moved"
ln -s "/opt/psygen moved" "$root/opt/psygen"
programs /opt/psygen/bin /opt/psygen/bin
echo "package_test: all passed"
