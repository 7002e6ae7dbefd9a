#!/usr/bin/env bash
# Tries what the complete check (.ci/run) leaves out, and writes result, date and revision of each row into
# docs/platforms.md. Takes a night on two cores.
#   tools/nightly.sh [ROW ...]     default: all rows, then all of tools/ports.sh
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/rows.sh

rows=(debian-12 debian-13 ubuntu-24.04 builds packages swiftshader fuzz starve long)

# A new system in build/nightly-NAME with a clone of this revision, in which the two commands of README.md run.
distribution() { # NAME SUITE ARCHIVE COMPONENTS KEYS PACKAGE-OF-KEYS SCRIPT-OF-OLDER-SUITES
  needs debootstrap unshare
  [ "$(id -u)" = 0 ] || leave_out "only root makes a new system"
  [ -e "/usr/share/keyrings/$5" ] || leave_out "/usr/share/keyrings/$5 is missing (package $6)"
  local root="$PWD/build/nightly-$1" scripts=/usr/share/debootstrap/scripts script=""
  # An older debootstrap does not know a newer suite, but its script for older ones serves.
  [ -e "$scripts/$2" ] || script="$scripts/$7"
  rm -rf --one-file-system "$root"
  debootstrap --force-check-gpg --keyring="/usr/share/keyrings/$5" --variant=minbase --components="$4" "$2" "$root" "$3" \
    ${script:+"$script"}
  git clone -q . "$root/psygen"
  echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/fast" # nobody needs the system after a crash
  cp --remove-destination /etc/resolv.conf "$root/etc/resolv.conf"
  # shellcheck disable=SC2016
  ROOT="$root" unshare --mount bash -ec '
    mount --bind /proc "$ROOT/proc"
    for folder in sys dev; do mount --rbind "/$folder" "$ROOT/$folder"; done
    exec chroot "$ROOT" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
      bash -ec "$0"' '
        apt-get update -qq
        apt-get install -y -qq --no-install-recommends ca-certificates git >/dev/null
        git config --global --add safe.directory /psygen
        cd /psygen
        tools/demo.sh --headless --seconds 3
        tools/test.sh'
  sed -n 's/^100% tests passed, 0 tests failed out of \([0-9]*\)$/both commands of README.md: \1 tests pass/p' \
    "build/nightly-$1.log" >&3
  rm -rf --one-file-system "$root"
}
debian() { # NAME SUITE
  distribution "$@" http://deb.debian.org/debian main debian-archive-keyring.gpg debian-archive-keyring sid
}
how_debian_12="a new system, GCC 12.2, Mesa 22.3"
row_debian_12() { debian debian-12 bookworm; }
how_debian_13="a new system, GCC 14.2, Mesa 25.0, GLFW 3.4, Qt 6.8"
row_debian_13() { debian debian-13 trixie; }
how_ubuntu_24_04="a new system, GCC 13, Mesa 24"
row_ubuntu_24_04() {
  distribution ubuntu-24.04 noble http://archive.ubuntu.com/ubuntu main,universe ubuntu-archive-keyring.gpg \
    "ubuntu-keyring, which Debian has since 13" gutsy
}

how_builds="GCC and clang, static and shared: installed, used by another project"
row_builds() { tools/builds.sh; }

how_packages="\`.deb\` files and the archive, in a new Debian 12 (\`tools/package_test.sh\`)"
row_packages() {
  needs debootstrap cpack
  [ "$(id -u)" = 0 ] || leave_out "only root makes a new system"
  tools/package.sh
  tools/package_test.sh build/package/packages "$PWD/build/nightly-packages"
}

how_swiftshader="golden images and validation on SwiftShader"
row_swiftshader() {
  local driver=/usr/lib/chromium/vk_swiftshader_icd.json
  [ -e "$driver" ] || leave_out "chromium is not installed"
  VK_DRIVER_FILES="$driver" build/release/bin/psygen_test_pictures --gtest_brief=1 --gtest_filter='Golden*'
  tools/validation.sh "$driver"
}

how_fuzz="libFuzzer, an hour a target"
row_fuzz() { tools/fuzz.sh 3600; }

how_starve="all tests beside busy processes, on one core, at the lowest priority"
row_starve() { tools/starve.sh release 1; }

how_long="a flight of an hour without a leak (\`ctest -L long\`)"
row_long() { ctest --test-dir build/release -L long --output-on-failure; }

failed=0
try_rows nightly --record "$@" || failed=1
[ $# -gt 0 ] || tools/ports.sh --record || failed=1
exit $failed
