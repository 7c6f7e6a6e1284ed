# SPDX-License-Identifier: Apache-2.0
# Sourced by in_guest: kernels that run as processes. Each gets a folder of its own ($state) with what it is to run, leaves the
# exit status there, and nothing else anywhere: processes and folder are gone when in_guest ends, however it ends.
# shellcheck shell=bash

state=
guest=
followers=()

# Longer than any boot seen: 2 s, and in QEMU 6 s; 80 s on a machine that was busy with five other things.
uml_boot=120
qemu_boot=300
qemu_slower=3
# Its time is that of an idle machine; on a busy one it passes more slowly.
uml_slower=3

quoted() { printf "'%s' " "${1//\'/\'\\\'\'}"; }

# What the guest runs: environment, directory and arguments as they are here.
write_command() {
  local pair name argument
  while IFS= read -r -d '' pair; do
    name=${pair%%=*}
    [[ "$name" =~ ^[A-Za-z_][A-Za-z_0-9]*$ && ! "$name" =~ ^(PWD|OLDPWD|SHLVL|_)$ ]] || continue
    printf 'export %s=%s\n' "$name" "$(quoted "${pair#*=}")"
  done < <(env -0)
  printf 'cd %s|| exit 125\n' "$(quoted "$PWD")"
  printf 'exec timeout -k 5 "$GUEST_LIMIT" '
  for argument in "$@"; do quoted "$argument"; done
  echo
}

# guest_begin COMMAND...: a new state folder, with the command in it.
guest_begin() {
  guest_end
  state=$(mktemp -d /var/tmp/axisgate-guest.XXXXXX) || exit 125
  trap guest_end EXIT
  trap 'exit 125' INT TERM HUP
  write_command "$@" >"$state/command"
  printf '%s' "$PWD" >"$state/directory"
  cp "$here/guest_init" "$state/init"
  chmod 0755 "$state/init"
}

guest_end() {
  [ -n "$state" ] || return 0
  if [ -n "$guest" ]; then kill "$guest" 2>/dev/null; wait "$guest" 2>/dev/null; fi
  guest=
  [ ${#followers[@]} -eq 0 ] || wait "${followers[@]}"
  followers=()
  # A kernel that was killed leaves processes behind: they carry our own folder in their command line.
  local process
  for process in /proc/[0-9]*; do
    case $(cat "$process/comm" 2>/dev/null) in
      linux.uml | qemu-system-x86*) grep -q -a -s -F "$state" "$process/cmdline" && kill -KILL "${process#/proc/}" 2>/dev/null ;;
    esac
  done
  rm -rf "$state"
  state=
}

# guest_wait SECONDS: waits for the guest in $guest, and ends in_guest with the command's status. Comes back only if the command was
# not started, within SECONDS. A status that has been left counts whatever becomes of the guest: some kernels abort, or hang, while
# they switch themselves off. What the shell says of such an end is nobody's concern (2>/dev/null).
guest_wait() {
  local tenths=$(($1 * 10)) ended
  {
    while [ ! -d "$state/started" ] && [ $((tenths--)) -gt 0 ] && kill -0 "$guest"; do sleep 0.1; done
    if [ -d "$state/started" ]; then
      while [ ! -s "$state/status" ] && kill -0 "$guest"; do sleep 0.2; done
    else
      kill "$guest"
    fi
    if [ -s "$state/status" ]; then exit "$(cat "$state/status")"; fi
    wait "$guest"
    ended=$?
  } 2>/dev/null
  guest=
  if [ -s "$state/status" ]; then exit "$(cat "$state/status")"; fi
  cat "$state/monitor.log" "$state/kernel.log" >&2
  [ ! -d "$state/started" ] || no_guest "the guest ended ($ended) before COMMAND did, its messages are above"
}

# In the process of User-Mode Linux alone: its time is its own (guest_clock.cpp), and what its version 6.1 hands over of a processor's
# state suffices for those with AMX, too (whole_state.cpp). Always, since that does nothing where the state is complete: so every
# machine tries what some need.
preload_for_uml() {
  local library=$state/preloaded.so
  c++ -std=c++20 -O2 -shared -fPIC -Wl,--as-needed -o "$library" "$here/whole_state.cpp" "$here/guest_clock.cpp" >&2 ||
    { say "going on without whole_state.cpp and guest_clock.cpp"; return 0; }
  printf 'LD_PRELOAD=%s' "$library"
}

run_in_user_mode_linux() {
  local missing=() need cpu preload
  for need in linux.uml:user-mode-linux modprobe:kmod ip:iproute2 taskset:util-linux; do
    command -v "${need%%:*}" >/dev/null || missing+=("${need#*:}")
  done
  if [ ${#missing[@]} -gt 0 ]; then
    say "for User-Mode Linux these packages are missing: ${missing[*]}. Run tests/setup"
    return 0
  fi
  # One CPU: kernel and processes hand over at each system call, which between two CPUs takes 2.5 times as long.
  cpu=$(sed -n 's/^Cpus_allowed_list:.*[^0-9]\([0-9]*\)$/\1/p' /proc/self/status)
  preload=$(preload_for_uml)
  say "this kernel has no vcan: running in User-Mode Linux"
  timeout -k 5 $((limit * uml_slower + uml_boot)) taskset -c "$cpu" env ${preload:+"$preload"} linux.uml mem=1024M root=/dev/root rootfstype=hostfs \
    rootflags=/ rw "init=$state/init" "uml_dir=$state" quiet \
    console=tty1 con=null ssl=null con0=null,fd:5 con2=null,fd:6 con1=null,fd:7 \
    "GUEST_STATE=$state" "GUEST_LIMIT=$limit" GUEST_KIND=uml ${preload:+AXISGATE_OWN_TIME=yes} 5>&1 6>&2 7>"$state/kernel.log" >"$state/monitor.log" 2>&1 </dev/null &
  guest=$!
  guest_wait "$uml_boot"
  say "User-Mode Linux did not start, its messages are above"
}

# On an emulated processor: the kernel is Debian's, the files are this machine's, by 9p. Once more, with one processor, where the guest
# did not start in time.
run_in_qemu() {
  local kernel processors=2
  "$here/../setup" --qemu >&2 || no_guest "what QEMU needs could not be installed"
  kernel=$(cd "$here/../../.deps/guest-kernel" && pwd) || exit 125
  [ "$(nproc)" -gt 1 ] || processors=1
  say "running on an emulated processor (QEMU), which takes many times as long"
  boot_qemu "$kernel" "$processors"
  say "QEMU's guest did not start, its messages are above: once more"
  guest_begin "$@"
  boot_qemu "$kernel" 1
}

boot_qemu() {
  local kernel=$1 processors=$2 longest=$((limit * qemu_slower))
  : >"$state/out"
  : >"$state/err"
  timeout -k 5 $((longest + qemu_boot)) qemu-system-x86_64 -accel tcg,thread=multi -cpu max -smp "$processors" -m 1024 \
    -nodefaults -no-user-config -no-reboot -display none -serial "file:$state/kernel.log" \
    -kernel "$kernel/vmlinuz" -initrd "$kernel/initrd.gz" \
    -fsdev local,id=root,path=/,security_model=none,multidevs=remap -device virtio-9p-pci,fsdev=root,mount_tag=root \
    -fsdev "local,id=state,path=$state,security_model=none" -device virtio-9p-pci,fsdev=state,mount_tag=state \
    -append "console=ttyS0 quiet panic=-1 mitigations=off nokaslr tsc=reliable no_timer_check GUEST_INIT=$state/init GUEST_STATE=$state GUEST_LIMIT=$longest GUEST_KIND=qemu GUEST_MODULES=$kernel/lib/modules" \
    >"$state/monitor.log" 2>&1 </dev/null &
  guest=$!
  # The command's output goes to files, which are followed: a console of QEMU drops what a full pipe does not take.
  tail -q -c +1 -s 0.2 -f --pid="$guest" "$state/out" &
  followers+=($!)
  tail -q -c +1 -s 0.2 -f --pid="$guest" "$state/err" >&2 &
  followers+=($!)
  guest_wait "$qemu_boot"
}
