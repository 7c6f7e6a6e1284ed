# SPDX-License-Identifier: Apache-2.0
"""Imported first by a story that needs a network of its own: it goes on in a network namespace with lo and two more interfaces, and
with a /dev/shm of its own, since shared memory knows no network."""
import atexit
import os
import subprocess
import sys

OTHER, OTHER_ADDRESS = "ag0", "10.77.0.1"
HOST, HOST_ADDRESS = "ag1", "10.77.0.2"

if "AXISGATE_OWN_NETWORK" not in os.environ:
    user = [] if os.geteuid() == 0 else ["--map-root-user"]
    os.execvpe("unshare", ["unshare", "--net", "--mount", *user, sys.executable, "-B", *sys.argv],
               {**os.environ, "AXISGATE_OWN_NETWORK": "1"})


def ip(*arguments):
    subprocess.run(["ip", *arguments], check=True)


def make_interfaces():
    """As a computer in a network has them: lo without the multicast flag, and an interface with the default route."""
    subprocess.run(["mount", "-t", "tmpfs", "-o", "size=256m", "tmpfs", "/dev/shm"], check=True)
    ip("link", "set", "lo", "up")
    ip("link", "add", OTHER, "type", "veth", "peer", "name", "ag1")
    ip("address", "add", f"{OTHER_ADDRESS}/24", "dev", OTHER)
    for name in (OTHER, "ag1"):
        ip("link", "set", name, "up")
    ip("route", "add", "default", "via", "10.77.0.2")


# A second host: a network namespace that has the other end of OTHER, and a /dev/shm of its own.
_host = None


def make_host():
    global _host
    _host = subprocess.Popen(["unshare", "--net", "--mount", "sh", "-c", "mount -t tmpfs tmpfs /dev/shm && echo ready && read end"],
                             stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    atexit.register(_host.stdin.close)
    assert _host.stdout.readline() == b"ready\n"
    ip("link", "set", HOST, "netns", str(_host.pid))
    for command in (("link", "set", "lo", "up"), ("address", "add", f"{HOST_ADDRESS}/24", "dev", HOST), ("link", "set", HOST, "up"),
                    ("route", "add", "default", "via", OTHER_ADDRESS)):
        subprocess.run([*in_host(), "ip", *command], check=True)


def in_host():
    """Before a command: it runs there."""
    return ["nsenter", "--target", str(_host.pid), "--net", "--mount"]
