#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Moves one axis and lets it go again, with mbpoll: move_mbpoll.sh HOST PORT AXIS UNITS RPM
#
# UNITS is the target in position units of the gateway (10000 a turn unless its units_per_rev says otherwise). mbpoll connects anew for each
# request: the listener needs "client": "address". There reads are no sign of life, so register 56 is counted up while the axis moves.
# Ctrl-C and SIGTERM stop it before the script ends; if the script dies, the gateway stops it when the lease has run out.
set -eu
host=$1 port=$2 first=$((100 * $3)) units=$4 rpm=$5

# Addresses count from 0 (-0), 32-bit values have their high word first (-B).
ask() { mbpoll -m tcp -p "$port" -0 -B -1 -q -o 5 "$@"; }
value() { ask -t "$1" -r $((first + $2)) "$host" | sed -n 's/^\[.*\]:[[:space:]]*//p'; }
write() { ask -t "$1" -r $((first + $2)) "$host" -- "$3" >/dev/null; }
# One number alone is a button: it acts when it changes, so the 0 comes first.
command() { write 4 54 0 && write 4 54 "$1"; }

[ "$(value 4 18)" = 2 ] || { echo "axis $3 is not online" >&2; exit 1; }
there=no
finish() {
  trap - EXIT
  trap '' INT TERM
  [ $there = yes ] || command 3 || true # quick stop
  command 2 || true                     # disable
  command 13 || true                    # release: others need not wait for the end of the lease
}
trap finish EXIT
trap 'echo stopping >&2; exit 1' INT TERM # what is interrupted may have its output redirected

command 1 # enable
write 4:int 48 $((rpm * 1000))
write 4:int 42 "$units"
command 6 # move to target_position
echo "moving to $units"
count=0
while [ "$(value 4 32)" = 1 ]; do # motion_state: active
  count=$((count % 65535 + 1))
  write 4 56 $count # heartbeat: a sign of life
  sleep 0.2
done
[ "$(value 4 32)" = 2 ] || { echo "the move has ended in motion state $(value 4 32)" >&2; exit 1; }
there=yes
echo "there: $(value 4:int 2)"
