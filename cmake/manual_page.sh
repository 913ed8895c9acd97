#!/bin/sh
# Prints quadedge(1), which is the help of PROGRAM and of all its commands.
#   manual_page.sh PROGRAM
set -eu
program="$1"
literal() { sed -e 's/\\/\\e/g' -e 's/-/\\-/g' -e "s/^\([.']\)/\\\\\&\1/"; }
section() {  # TITLE ARGUMENTS...
  title="$1"
  shift
  printf '.SH "%s"\n.EX\n' "$title"
  text=$("$program" "$@")
  printf '%s\n' "$text" | literal
  echo .EE
}
commands() { "$program" "$@" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p'; }

echo '.TH QUADEDGE 1 "" "" "User Commands"'
echo '.SH NAME'
echo 'quadedge \- stereo visual odometry from quadruplets of third-order edges'
section 'quadedge' --help
for command in $(commands); do
  case $command in
    evaluate) for kind in $(commands evaluate); do section "quadedge evaluate $kind" evaluate "$kind" --help; done ;;
    run) section 'quadedge run' run --help-all ;;  # with all constants of the method, which other commands share
    *) section "quadedge $command" "$command" --help ;;
  esac
done
cat <<'END'
.SH ENVIRONMENT
.TP
.B QUADEDGE_DEVICE
default of
.B \-\-device
.TP
.B QUADEDGE_PYTHON
the Python that makes HTML pages; it must have the module quadedge.report
.TP
.B XDG_CONFIG_HOME
folder of the kernel variants that
.B quadedge compare \-\-save
keeps (~/.config)
END
