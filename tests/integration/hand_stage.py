# SPDX-License-Identifier: Apache-2.0
"""What the stories of `axisgate enable|move|jog|stop` need: the command on a terminal of its own, and a network that can be cut."""
import fcntl
import os
import pty
import select
import socket
import struct
import subprocess
import termios
import threading

from lease_stage import Machine
from modbus import DISABLED
from processes import NEVER, until
from stage import AXISGATE, PORTS

RIGHT, LEFT, CTRL_C = b"\x1b[C", b"\x1b[D", b"\x03"
WRITE_COIL = 5


class OnTerminal:
    """A program whose controlling terminal is ours: keys go in, what it shows comes out."""

    def __init__(self, command, **options):
        self.master, slave = pty.openpty()
        self.slave = os.dup(slave)  # kept, so that its modes can be read when the program is gone
        self.modes = termios.tcgetattr(slave)
        self.shown = b""
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 120, 0, 0))

        def own_terminal():
            os.setsid()
            fcntl.ioctl(0, termios.TIOCSCTTY, 0)

        self.process = subprocess.Popen(command, stdin=slave, stdout=slave, stderr=slave, preexec_fn=own_terminal, **options)
        os.close(slave)
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()

    def _read(self):
        ended = False  # what it said last is looked for once more after its end
        while True:
            try:
                if select.select([self.master], [], [], 0.1)[0]:
                    self.shown += os.read(self.master, 4096)
                elif ended:
                    return
                else:
                    ended = self.process.poll() is not None
            except (OSError, ValueError):
                return

    def text(self):
        return self.shown.decode(errors="replace")

    def press(self, key):
        os.write(self.master, key)

    def wait_for(self, words):
        until(f"it shows '{words}'", lambda: words in self.text() or self.process.poll() is not None)
        assert words in self.text(), f"it has ended without '{words}':\n{self.text()}"

    def hang_up(self):
        """The window is closed, the line of the remote shell is cut."""
        master, self.master = self.master, -1
        os.close(self.slave)
        self.slave = -1
        os.close(master)

    def ended(self):
        code = self.process.wait(timeout=NEVER)
        self.reader.join(timeout=NEVER)
        return code

    def clean_up(self):
        if self.process.poll() is None:
            self.process.kill()
        self.ended()
        for descriptor in (self.master, self.slave):
            if descriptor >= 0:
                os.close(descriptor)
        self.master = self.slave = -1


class Network:
    """Stands between a command and the gateway, and knows what was asked. Cut, it carries nothing, and says nothing of it."""

    def __init__(self, port):
        self.port, self.is_cut = port, False
        self.requests = []  # function, address, value
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.sockets = []
        self.thread = threading.Thread(target=self._accept, daemon=True)
        self.thread.start()

    @property
    def address(self):
        return "127.0.0.1:%d" % self.listener.getsockname()[1]

    def _accept(self):
        while True:
            try:
                near = self.listener.accept()[0]
            except OSError:
                return
            far = socket.create_connection(("127.0.0.1", self.port))
            for end in (near, far):
                end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self.sockets += [near, far]
            threading.Thread(target=self._carry, args=(near, far, True), daemon=True).start()
            threading.Thread(target=self._carry, args=(far, near, False), daemon=True).start()

    def _carry(self, source, sink, watched):
        rest = b""
        try:
            while data := source.recv(4096):
                if self.is_cut:
                    continue
                if watched:
                    rest = self._note(rest + data)
                sink.sendall(data)
            sink.shutdown(socket.SHUT_WR)
        except OSError:
            pass

    def _note(self, data):
        while len(data) >= 6 and len(data) >= (size := 6 + int.from_bytes(data[4:6], "big")):
            pdu = data[7:size]
            self.requests.append((pdu[0], int.from_bytes(pdu[1:3], "big"), int.from_bytes(pdu[3:5], "big")))
            data = data[size:]
        return data

    def presses(self):
        return len([value for function, _, value in self.requests if function == WRITE_COIL and value])

    def cut(self):
        self.is_cut = True

    def kill(self):
        """As a relay that is killed: its connections are closed at once."""
        for end in self.sockets:
            end.close()

    def clean_up(self):
        self.listener.close()
        for end in self.sockets:
            try:
                end.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass
            end.close()


class Hand(Machine):
    """Axis 1 is a servo, axis 2 a stepper. The lease outlives a machine that is busy with something else."""

    lines_of = ("serial", "stepper")
    lease = {"timeout_ms": 10000}

    def setUp(self):
        super().setUp()
        self.begin()

    @property
    def address(self):
        return f"127.0.0.1:{self.ports[0]}"

    def network(self):
        network = Network(self.ports[0])
        self.addCleanup(network.clean_up)
        return network

    def on_terminal(self, *arguments, address=None):
        name, *rest = arguments
        program = OnTerminal([AXISGATE, name, address or self.address, *map(str, rest)])
        program.name = f"axisgate {name}"
        return self.keep(program)

    def hand(self, *arguments):
        """To its end, without a terminal."""
        name, *rest = arguments
        return self.command_line(name, self.address, *map(str, rest))

    def assert_disabled(self, number):
        axis = self.watched(number)
        axis.until(axis_state=DISABLED) if not axis.inputs() & {"stop_latched"} else axis.until_input("enabled", False)
        self.until_it_stands(number)
        self.until_without_torque(number)
