# Runs the rows of a script's table. A script sources this file, declares an array `rows`, and for each row NAME, with "_"
# for "-", a text how_NAME and a function row_NAME. The last words of the function on descriptor 3 are its result.
#
# try_rows TABLE [--record] [NAME ...]   runs these rows (default: all) and prints the table
#   --record   replaces their lines in docs/platforms.md. Rows that are left out keep their last result there.
# Messages are in build/TABLE-NAME.log. Exit code 1: a row failed; 2: there is no such row.

# leave_out REASON   ends a row that this machine cannot run
leave_out() {
  echo "left out: $1" >&3
  exit 77
}

# needs COMMAND ...   leaves the row out if a command is missing
needs() {
  local command
  for command in "$@"; do
    command -v "$command" >/dev/null || leave_out "$command is not installed"
  done
}

try_rows() {
  local table="$1" record="" name function how said status result row revision failed=0
  shift
  [ "${1:-}" = "--record" ] && { record=yes; shift; }
  for name in "$@"; do
    [[ " ${rows[*]} " == *" $name "* ]] || { echo "$table: no row $name; there are ${rows[*]}" >&2; return 2; }
  done
  [ $# -gt 0 ] || set -- "${rows[@]}"
  mkdir -p build
  revision="$(git rev-parse --short HEAD 2>/dev/null || echo unknown)"
  echo "| name | how | result | date | revision |"
  echo "| --- | --- | --- | --- | --- |"
  for name in "$@"; do
    function="row_${name//[-.]/_}" how="how_${name//[-.]/_}"
    said="$( (set -e; "$function") 3>&1 >"build/$table-$name.log" 2>&1)"
    status=$?
    case $status in
      0 | 77) result="${said##*$'\n'}" ;;
      *) result="failed" failed=1 ;;
    esac
    row="| $name | ${!how} | ${result:-passes} | $(date -u +%F) | $revision |"
    echo "$row"
    [ $status -ne 0 ] && tail -5 "build/$table-$name.log" | sed 's/^/  /' >&2
    [ -n "$record" ] && [ $status -ne 77 ] &&
      NAME="$name" ROW="$row" perl -pi -e 's/^\| \Q$ENV{NAME}\E \|.*$/$ENV{ROW}/' docs/platforms.md
  done
  return $failed
}
