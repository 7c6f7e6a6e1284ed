# SPDX-License-Identifier: Apache-2.0
"""A crowd of clients takes all descriptors there are; a serial port that comes back finds one below 1024 all the same."""
import os
import resource
import socket
import struct
import subprocess

from modbus import LINK_DOWN, ONLINE
from processes import NEVER, Program, until
from stage import AXISGATE, Story, bus, drive, main

SELECT_LIMIT = 1024  # what select() can watch, and so what libmodbus can
LISTENERS, LET_IN = 2, 1000  # so many clients each
CROWD = 1500
LATE = 100  # of them come while the cable is out, and would take the number of its port
TOO_MANY = 20
LINK_STATE = 118  # of axis 1
CONNECTED = "01"  # in /proc/PID/net/tcp
OWN_END, STATE, INODE = 1, 3, 9


def hard_limit():
    hard = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
    return 1 << 30 if hard == resource.RLIM_INFINITY else hard


def allow_descriptors(count):
    """To this test, which holds the other ends."""
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(count, hard_limit()), resource.getrlimit(resource.RLIMIT_NOFILE)[1]))


class Crowd(Story):
    # What another adapter changes: the line as axisgate-sim takes it, and the bus that hangs on it.
    lines = {"lift": "jd@1"}
    adapter = "kinco-serial"

    def buses(self):
        return [bus(self.path("lift"), drive("jd", 1, 1), adapter=self.adapter)]

    def begin(self, limits):
        """Drive and gateway, the latter started with these limits, SOFT:HARD; two listeners share the crowd."""
        self.under = ["prlimit", f"--nofile={limits}"]
        self.simulate()
        self.configure([self.listener(max_clients=LET_IN, max_clients_per_address=0) for _ in range(LISTENERS)])
        self.gateway = self.keep(Program("axisgate run", [*self.under, AXISGATE, "run", self.config]))
        self.gateway.wait_for("listening on ", LISTENERS)
        self.client = self.connect()
        self.until_online()
        self.crowd = []
        self.addCleanup(lambda: [connection.close() for connection in self.crowd])

    def come(self, count):
        for number in range(count):
            self.crowd.append(socket.create_connection(("127.0.0.1", self.ports[number % LISTENERS]), timeout=NEVER))

    def served(self):
        """How many of the crowd are answered; all ask before the first is listened to. Who was closed is out of it."""
        for connection in self.crowd:
            try:
                connection.sendall(struct.pack(">HHHBBHH", 7, 0, 6, 1, 3, LINK_STATE, 1))
            except (BrokenPipeError, ConnectionResetError):
                pass  # seen below
        for connection in list(self.crowd):
            try:
                answer = connection.recv(11)
            except ConnectionResetError:
                answer = b""
            if answer:
                self.assertEqual(answer[:9], struct.pack(">HHHBBB", 7, 0, 5, 1, 3, 2))
            else:
                connection.close()
                self.crowd.remove(connection)
        return len(self.crowd)

    # What the gateway's process has open.

    def descriptors(self):
        """Number -> what it is; one that is closed while we look is left out."""
        folder, seen = f"/proc/{self.gateway.pid}/fd", {}
        for number in os.listdir(folder):
            try:
                seen[int(number)] = os.readlink(f"{folder}/{number}")
            except FileNotFoundError:
                pass
        return seen

    def client_descriptors(self):
        """The numbers of its ends of connections with clients."""
        ports = {f"{port:04X}" for port in self.ports}
        with open(f"/proc/{self.gateway.pid}/net/tcp", encoding="ascii") as table:
            rows = [line.split() for line in list(table)[1:]]
        ours = {f"socket:[{row[INODE]}]" for row in rows if row[STATE] == CONNECTED and row[OWN_END].rpartition(":")[2] in ports}
        return [number for number, what in self.descriptors().items() if what in ours]

    def port_descriptor(self):
        pty = os.path.realpath(self.path("lift"))
        numbers = [number for number, what in self.descriptors().items() if what == pty]
        self.assertEqual(len(numbers), 1, f"{pty} among {self.descriptors()}")
        return numbers[0]

    def pull_fill_and_put_back(self, late):
        """The cable goes, clients come and take what it left, the cable is back and so is the axis."""
        self.sim.ask("unplug lift")
        self.axis(1).until(link_state=LINK_DOWN)
        self.come(late)
        served = self.served()
        self.sim.ask("plug lift")
        self.axis(1).until(link_state=ONLINE)
        self.assertEqual(self.client.bus(0)["reconnects"], 1)
        self.assertLess(self.port_descriptor(), SELECT_LIMIT)
        return served

    def test_a_port_comes_back_among_1500_clients(self):
        allow_descriptors(2 * CROWD)
        self.begin(f"{min(SELECT_LIMIT, hard_limit())}:")  # it raises the limit itself
        if hard_limit() < SELECT_LIMIT + LISTENERS * LET_IN:
            self.gateway.wait_for("warning gateway: at most")  # no room on this system, and the gateway says so
            return
        self.come(CROWD - LATE)
        self.assertEqual(self.served(), CROWD - LATE)
        self.assertEqual(self.pull_fill_and_put_back(LATE), CROWD)
        self.assertEqual(self.served(), CROWD, "all stayed connected")
        numbers = self.client_descriptors()
        self.assertEqual(len(numbers), CROWD + 1, "the crowd and the story's own client")
        self.assertGreaterEqual(min(numbers), SELECT_LIMIT)
        self.assertEqual(self.gateway.found("at most|refused"), [])
        self.axis(1).command("enable")
        self.axis(1).command("disable")

    def test_where_no_number_above_1023_is_allowed_clients_are_limited(self):
        allow_descriptors(2 * CROWD)
        limit = min(SELECT_LIMIT, hard_limit())
        self.begin(f"{limit}:{limit}")
        warning = rf"at most (\d+) clients at once, though max_clients allows 2000: .* {limit} files open, .*LimitNOFILE"
        said = self.gateway.wait_for(f"warning gateway: {warning}")
        self.assertEqual(len(said), 1)
        check = subprocess.run([*self.under, AXISGATE, "check", self.config], capture_output=True, text=True, timeout=NEVER, check=True)
        self.assertRegex(check.stdout, f"warning: started from here, {warning}")
        self.assertIn(f"at most {said[0][1]} clients", check.stdout)

        room = int(said[0][1]) - 1  # the story's own client has a place
        self.come(room - LATE)
        self.assertEqual(self.served(), room - LATE)
        self.assertEqual(self.pull_fill_and_put_back(LATE + TOO_MANY), room)
        self.assertEqual(self.served(), room, "all stayed connected")
        self.assertLess(max(self.descriptors()), SELECT_LIMIT)
        refused = self.gateway.wait_for("refused 127.0.0.1: the system's descriptor limit is reached")
        self.assertLessEqual(len(refused), LISTENERS, "once a minute each")
        self.crowd.pop().close()

        def newcomer_is_served():
            self.come(1)
            return self.served() == room

        until("the free place is given away", newcomer_is_served)


class CrowdBesideModbusRtu(Crowd):
    """The same where libmodbus has the port: it refuses to wait for one above 1023."""

    lines = {"lift": "rtu:jd@1"}
    adapter = "modbus-rtu"

    def test_a_port_comes_back_among_1500_clients(self):
        super().test_a_port_comes_back_among_1500_clients()
        self.assertEqual(self.gateway.found("warning bus lift: .*descriptor"), [])


if __name__ == "__main__":
    main()
