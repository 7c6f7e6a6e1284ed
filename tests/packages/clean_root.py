# SPDX-License-Identifier: Apache-2.0
"""A clean Debian in a folder: what runs in it, a stand-in for its systemd, and two network namespaces with a cable between them."""
import configparser
import os
import re
import subprocess
import sys
import threading
from pathlib import Path

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../integration"))
from processes import Program, until  # noqa: E402 where the stories have it

LONG = 600  # seconds; for what downloads or unpacks
# A service manager that does what it is told by a test: the packages' scripts call it as they call the real one.
SYSTEMCTL = """#!/bin/sh
echo "$*" >>/run/stage/calls
verb=
for word; do case $word in -*) ;; *) verb=$word; break ;; esac; done
case $verb in
  is-active) test -e /run/stage/active ;;
  is-enabled) ls /etc/systemd/system/*.wants/axisgate.service >/dev/null 2>&1 && echo enabled ;;
  start | stop | restart | try-restart)
    echo "$verb" >/run/stage/request
    read -r answer </run/stage/answer
    test "$answer" = done
    ;;
esac
"""


def run(*command, **options):
    options.setdefault("timeout", LONG)
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          stdin=subprocess.DEVNULL, check=False, **options)
    if done.returncode:
        raise AssertionError(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stdout}")
    return done.stdout


class Network:
    """A network namespace of its own, kept by a process that does nothing."""

    def __init__(self):
        self.holder = subprocess.Popen(["unshare", "--net", "sleep", "infinity"])
        ours = os.readlink("/proc/self/ns/net")
        until("a network namespace", lambda: os.readlink(f"/proc/{self.holder.pid}/ns/net") != ours)
        run(*self.command("ip", "link", "set", "lo", "up"))

    def command(self, *command):
        return ["nsenter", f"--net=/proc/{self.holder.pid}/ns/net", *map(str, command)]

    def cable_to(self, other, ours, theirs):
        """A wire between the two with an address at each end."""
        run(*self.command("ip", "link", "add", "wire", "type", "veth", "peer", "name", "wire", "netns", other.holder.pid))
        for network, address in ((self, ours), (other, theirs)):
            run(*network.command("ip", "address", "add", f"{address}/24", "dev", "wire"))
            run(*network.command("ip", "link", "set", "wire", "up"))

    def close(self):
        self.holder.kill()
        self.holder.wait()


class CleanRoot:
    def __init__(self, folder, tar):
        self.path = Path(folder)
        self.path.mkdir()
        run("tar", "-C", self.path, "-xf", tar)
        run("mount", "-t", "proc", "proc", self.path / "proc")
        run("mount", "-t", "devpts", "-o", "newinstance,ptmxmode=0666,mode=0620,gid=5", "devpts", self.path / "dev/pts")
        (self.path / "dev/ptmx").unlink()
        (self.path / "dev/ptmx").symlink_to("pts/ptmx")
        for name in ("resolv.conf", "hosts"):
            (self.path / "etc" / name).write_bytes(Path("/etc", name).read_bytes())
        proxies = [line for line in run("apt-config", "dump").splitlines() if re.match(r"Acquire::https?::proxy ", line, re.IGNORECASE)]
        # As in a container or at an installer: nothing may be left to chance, and nobody can be asked.
        settings = ('Acquire::Retries "5";', 'APT::Sandbox::User "root";', 'APT::Get::Assume-Yes "true";', 'APT::Install-Recommends "false";')
        (self.path / "etc/apt/apt.conf.d/99test").write_text("\n".join((*proxies, *settings)) + "\n")
        self.environment = {"PATH": "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin", "DEBIAN_FRONTEND": "noninteractive",
                            "LC_ALL": "C.UTF-8", "HOME": "/root"}

    def command(self, *command, network=None):
        inside = ["env", "-i", *(f"{key}={value}" for key, value in self.environment.items()), "chroot", str(self.path), *map(str, command)]
        return network.command(*inside) if network else inside

    def run(self, *command, network=None):
        return run(*self.command(*command, network=network))

    def apt(self, *words):
        return self.run("apt-get", "-q", *words)

    def type(self, folder, command):
        """A command of a page, in a folder of /root."""
        return self.run("sh", "-c", f"cd /root/{folder} && {command}")

    def put(self, deb, folder="."):
        """The file where apt in there finds it: its path there."""
        to = self.path / "root" / folder / deb.name
        to.parent.mkdir(parents=True, exist_ok=True)
        to.write_bytes(deb.read_bytes())
        return f"/root/{folder}/{deb.name}"

    def installed(self):
        """Names of all packages that dpkg knows something of, with their state."""
        lines = self.run("dpkg-query", "-W", "-f", "${Package} ${db:Status-Abbrev}\n").splitlines()
        return {line.split()[0]: line.split()[1] for line in lines}

    def listing(self):
        """Every path, and what small files of /etc hold, but for what apt and dpkg keep for themselves."""
        own = re.compile(r"/(proc|sys|dev|run|tmp|root)(/|$)|/var/(cache|log|lib/apt|lib/dpkg)/|/etc/(passwd|group|shadow|gshadow)-$"
                         r"|/etc/ld\.so\.cache$")
        found = {}
        for folder, folders, files in os.walk(self.path):
            for name in folders + files:
                path = Path(folder, name)
                inside = "/" + str(path.relative_to(self.path))
                if own.match(inside):
                    continue
                text = path.read_bytes() if inside.startswith("/etc/") and path.is_file() and not path.is_symlink() else b""
                found[inside] = text
        return found

    def processes_of(self, user):
        """Those that run as this user of the clean root."""
        lines = [line.split(":") for line in (self.path / "etc/passwd").read_text().splitlines()]
        numbers = [int(line[2]) for line in lines if line[0] == user]
        found = []
        for pid in filter(str.isdigit, os.listdir("/proc")):
            try:
                if os.stat(f"/proc/{pid}").st_uid in numbers:
                    found.append(int(pid))
            except OSError:
                continue
        return found

    def close(self):
        for mounted in ("dev/pts", "proc", "sys"):
            if os.path.ismount(self.path / mounted):
                run("umount", "--lazy", "--recursive", self.path / mounted)


class Unit:
    """axisgate.service of the clean root, run by this test as its file says, and told to the package's scripts by a systemctl."""

    def __init__(self, root, network):
        self.root, self.network, self.program, self.programs, self.failure = root, network, None, [], None
        stage = root.path / "run/stage"
        stage.mkdir(parents=True)
        (root.path / "run/systemd/system").mkdir(parents=True)
        for fifo in ("request", "answer"):
            os.mkfifo(stage / fifo)
        self.stage = stage
        (root.path / "usr/bin/systemctl").write_text(SYSTEMCTL)
        (root.path / "usr/bin/systemctl").chmod(0o755)
        threading.Thread(target=self._serve, daemon=True).start()

    def calls(self):
        """What the scripts have asked systemd for since the last look."""
        path = self.stage / "calls"
        lines = path.read_text().splitlines() if path.exists() else []
        path.unlink(missing_ok=True)
        return lines

    def _serve(self):
        while True:
            verb = (self.stage / "request").read_text().strip()
            answer = "done"
            try:
                self._do(verb)
            except Exception as failure:  # told to the script, and by the test that looks
                self.failure, answer = failure, "failed"
            (self.stage / "answer").write_text(answer + "\n")

    def _do(self, verb):
        running = self.program is not None
        if verb in ("stop", "restart", "try-restart") and running:
            self.stop()
        if verb in ("start", "restart") or (verb == "try-restart" and running):
            self.start()

    def words(self):
        file = configparser.RawConfigParser(strict=False, delimiters="=", comment_prefixes="#")
        file.optionxform = str
        file.read(self.root.path / "lib/systemd/system/axisgate.service")
        return {key: value for section in file.sections() for key, value in file.items(section)}

    def start(self):
        """User, groups and rights as the unit has them; what systemd would make first is made."""
        unit = self.words()
        user = unit["User"]
        entries = [line.split(":") for line in (self.root.path / "etc/group").read_text().splitlines()]
        groups = [number for name, _, number, members in entries if name == user or user in members.split(",")]
        for kind, folder in (("StateDirectory", "var/lib"), ("RuntimeDirectory", "run")):
            for name in unit.get(kind, "").split():
                self.root.run("install", "-d", "-o", user, "-g", user, f"/{folder}/{name}")
        rights = ",".join(["-all", *("+" + right.lower().removeprefix("cap_") for right in unit.get("AmbientCapabilities", "").split())])
        command = self.root.command(
            "setpriv", f"--reuid={user}", f"--regid={user}", f"--groups={','.join(groups)}",
            f"--inh-caps={rights}", f"--ambient-caps={rights}", f"--bounding-set={rights}", "--no-new-privs", *unit["ExecStart"].split(),
            network=self.network)
        self.program = Program("axisgate.service", command)
        self.programs.append(self.program)
        (self.stage / "active").touch()
        self.program.wait_for("listening on ")

    def stop(self):
        (self.stage / "active").unlink()
        program, self.program = self.program, None
        code = program.terminate()
        assert code == 0, f"the gateway has ended with {code}:\n{program.text()}"

    def close(self):
        for program in self.programs:
            program.clean_up()
