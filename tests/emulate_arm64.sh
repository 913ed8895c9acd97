#!/usr/bin/env bash
# Runs a command where the kernel starts ARM64 programs with QEMU: in a user namespace of its own, which Linux 6.7 and
# later let register them, so that nothing changes for the rest of the machine. Needs the rights of root.
#   emulate_arm64.sh COMMAND...
set -euo pipefail
magic='\x7fELF\x02\x01\x01\x00\x00\x00\x00\x00\x00\x00\x00\x00\x02\x00\xb7\x00'
mask='\xff\xff\xff\xff\xff\xff\xff\x00\xff\xff\xff\xff\xff\xff\xff\xff\xfe\xff\xff\xff'
export QEMU=":qemu-aarch64:M::$magic:$mask:/usr/bin/qemu-aarch64-static:OCF"
unshare --user --keep-caps --mount bash -c '
  until [ "$(id -u)$(id -g)" = 00 ]; do sleep 0.1; done
  exec bash -ec "
    mount -t binfmt_misc none /proc/sys/fs/binfmt_misc
    printf %s \"\$QEMU\" >/proc/sys/fs/binfmt_misc/register
    exec \"\$@\"" bash "$@"' bash "$@" <&0 &
namespace=$!
until [ "$(readlink "/proc/$namespace/ns/user")" != "$(readlink /proc/self/ns/user)" ]; do sleep 0.1; done
echo 0 0 65536 >"/proc/$namespace/uid_map"
echo 0 0 65536 >"/proc/$namespace/gid_map"
wait "$namespace"
