# SPDX-License-Identifier: Apache-2.0
"""Many clients at once: each gets its own right answers; limits, roles and slow ones hurt nobody else."""
import socket
import struct

from pymodbus.client import ModbusTcpClient

from modbus import ABORTED, AXIS, COMPLETED, CONTINUOUS, NO_FUNCTION, OFFLINE, ONLINE, REFUSED, STANDSTILL, SUSPECT, Axis, Client, Closed, encode
from processes import NEVER, until
from stage import Story, main

TURN = 10000
FAR = 20000 * TURN
RPM = 1000
PATIENT = {"start_deadline_ms": 60000, "reply_deadline_ms": 60000}
ROUNDS = 10
# One writer for each row of each axis.
ROWS = ["target_position", "target_velocity", "profile_velocity", "profile_acceleration", "profile_deceleration", "homing_speed_switch",
        "homing_speed_zero", "homing_acceleration"]


def read_request(number, address, count):
    return struct.pack(">HHHBBHH", number, 0, 6, 1, 3, address, count)


def read_reply(connection):
    """Transaction number and registers; the socket has its own deadline."""
    head = connection.recv(6, socket.MSG_WAITALL)
    if len(head) < 6:
        raise Closed("by the gateway")
    number, _, length = struct.unpack(">HHH", head)
    pdu = connection.recv(length, socket.MSG_WAITALL)[1:]
    return number, struct.unpack(f">{pdu[1] // 2}H", pdu[2:])


class AllAtOnce(Story):
    def setUp(self):
        super().setUp()
        patient = [{**each, "timeout_ms": 5000} for each in self.buses()]
        self.start([self.listener(**PATIENT)], patient)

    def write_row(self, number, name):
        """Its own row, again and again; each answer is followed by a read that must show it."""
        client = Client(self.ports[0])
        try:
            axis = client.axis(number)
            for turn in range(1, ROUNDS + 1):
                value = 65537 * turn  # both words are the same number
                axis.set(**{name: value})
                shown = axis.get(name)
                assert abs(shown - value) <= 400, f"{name} of axis {number}: wrote {value}, read {shown}"
                assert axis.get("command_result") == 2
            return 65537 * ROUNDS
        finally:
            client.close()

    def read_everything(self, number):
        client = Client(self.ports[0])
        try:
            seen = set()
            for _ in range(5 * ROUNDS):
                block = client.axis(number).block()
                assert block["link_state"] in (ONLINE, SUSPECT), block["link_state"]
                if number == 1:  # the JD's counts are our units: nothing is rounded
                    assert block["target_position"] >> 16 == block["target_position"] & 0xFFFF, block["target_position"]
                seen.add(block["sequence"])
                assert client.gateway()["word_order_test"] == 0x01020304
                assert client.overview(number)["link_state"] in (ONLINE, SUSPECT)
            return seen
        finally:
            client.close()

    def test_32_clients_read_and_write(self):
        writers = {(number, name): self.later(self.write_row, number, name) for number in (1, 2) for name in ROWS}
        readers = [self.later(self.read_everything, 1 + index % 2) for index in range(16)]
        self.assertEqual(len(writers) + len(readers), 32)
        for work in [*readers, *writers.values()]:
            work.result(timeout=NEVER)
        for (number, name), writer in writers.items():
            with self.subTest(axis=number, row=name):
                self.assertAlmostEqual(self.axis(number).get(name), writer.result(), delta=400)
        for drive in ("lift/1", "feeder/1"):
            self.assertEqual(self.sim.writes(drive, "6083.00"), ROUNDS, "each write reached the drive once")
        self.assertEqual(self.client.bus(0)["timeouts"], 0)

    def test_readers_of_an_unresponsive_axis_wait_for_nothing(self):
        self.sim.ask("unresponsive lift/1 on")
        readers = [self.later(self.read_everything_of_both) for _ in range(16)]
        for reader in readers:
            self.assertLessEqual(reader.result(timeout=NEVER), {ONLINE, SUSPECT, OFFLINE})
        self.assert_online(self.axis(2))

    def read_everything_of_both(self):
        client = Client(self.ports[0])
        try:
            states = set()
            for _ in range(5 * ROUNDS):
                states.add(client.axis(1).block()["link_state"])
                assert client.axis(2).block()["link_state"] == ONLINE
            return states
        finally:
            client.close()

    def test_pipelined_requests_are_answered_in_order(self):
        with socket.create_connection(("127.0.0.1", self.ports[0]), timeout=NEVER) as connection:
            names = ["link_state", "sequence", "supported_modes", "map"] * 10
            offsets = [118, 124, 138, 0] * 10
            connection.sendall(b"".join(read_request(number, offset, 1) for number, offset in enumerate(offsets)))
            for number, name in enumerate(names):
                answered, registers = read_reply(connection)
                self.assertEqual(answered, number)
                if name == "map":
                    self.assertEqual(registers, (1,))

    def test_two_clients_command_one_axis(self):
        ours, theirs = self.axis(1), self.connect().axis(1)
        ours.set(profile_velocity=600 * RPM, target_position=FAR)
        ours.coil("enable")
        ours.coil("start_absolute")
        theirs.until_input("moving")
        theirs.coil("quick_stop")
        self.assertEqual(theirs.get("command_result"), 2)
        ours.until(motion_state=ABORTED)
        for axis in (ours, theirs):
            self.assertIn("stop_latched", axis.inputs())
        ours.coil("start_absolute", False)
        with self.refused(REFUSED):
            ours.coil("start_absolute")
        self.assertEqual((ours.get("command_result"), theirs.get("command_result")), (9, 2), "each has its own result")
        theirs.coil("enable", False)  # after a stop a level acts on 0 -> 1 alone
        theirs.coil("enable")
        ours.until(axis_state=STANDSTILL)
        theirs.set(target_position=0)
        theirs.coil("start_absolute")
        ours.until(motion_state=COMPLETED)
        self.assertEqual(self.sim.object("lift/1", "607A.00"), 0, "the last set-point before the start counts")

    def test_a_client_that_leaves_in_the_middle_of_a_write_harms_nobody(self):
        self.sim.ask("reply-delay lift 60")
        for turn in range(5):
            with socket.create_connection(("127.0.0.1", self.ports[0]), timeout=NEVER) as connection:
                words = struct.pack(">2H", *encode("u32", 20000 + turn))
                offset = 100 + AXIS["profile_acceleration"][0]
                connection.sendall(struct.pack(">HHHBBHHB", turn, 0, 11, 1, 16, offset, 2, 4) + words)
        until("the last of them", lambda: abs(self.axis(1).get("profile_acceleration") - 20004) < 10)
        self.assert_online(self.axis(1))
        self.assertEqual(self.client.bus(0)["timeouts"], 0)


class Limits(Story):
    """What others do to the gateway; meanwhile somebody's motor runs, and he can stop it."""

    def set_running(self, axis):
        axis.set(profile_acceleration=30000, profile_deceleration=30000, target_velocity=100000)
        axis.command("enable")
        axis.command("run_velocity")
        self.assert_runs()

    def assert_runs(self):
        before = self.sim.object("lift/1", "6063.00")
        until("the motor turns on", lambda: self.sim.object("lift/1", "6063.00") > before)

    def assert_obeys(self, axis):
        self.assert_runs()
        self.assertEqual(axis.get("axis_state"), CONTINUOUS)
        axis.command("quick_stop")
        until("the motor stands", lambda: self.sim.object("lift/1", "606C.00") == 0)
        axis.until_input("stop_latched")

    def assert_closed(self, client):
        with self.assertRaises(Closed):
            client.registers(0)

    def test_one_client_too_many_is_closed_and_the_others_stay(self):
        self.simulate()
        for option in ("max_clients", "max_clients_per_address"):
            with self.subTest(option):
                self.configure([self.listener(**{option: 3})])
                self.run_gateway()
                clients = [self.connect() for _ in range(3)]
                self.client = clients[2]
                self.until_online()
                for client in clients:
                    client.registers(0)
                self.set_running(self.axis(1))
                self.assert_closed(self.connect())
                self.gateway.wait_for("refused")
                for client in clients:
                    self.assertEqual(client.gateway()["map_version"], 1)
                self.assert_obeys(self.axis(1))
                clients[0].close()
                until("a place is free", self.is_served)
                self.gateway.terminate()

    def is_served(self):
        client = Client(self.ports[0])
        try:
            return client.registers(0)
        except Closed:
            return None
        finally:
            client.close()

    def test_a_slow_client_is_cut_off_while_others_are_served(self):
        self.start()
        self.set_running(self.axis(1))
        slow = [socket.create_connection(("127.0.0.1", self.ports[0]), timeout=NEVER) for _ in range(20)]
        self.addCleanup(lambda: [connection.close() for connection in slow])
        for index, connection in enumerate(slow):
            connection.sendall(read_request(1, 100, 1)[:1 + index % 11])
        for connection in slow:
            connection.setblocking(False)
        left = set(slow)

        def look():
            self.assertEqual(self.client.gateway()["axes_online"], 2)
            for connection in list(left):
                try:
                    if connection.recv(1) == b"":
                        left.discard(connection)
                except BlockingIOError:
                    pass
                except ConnectionResetError:
                    left.discard(connection)
            return not left

        until("all slow clients are gone", look)
        self.assert_obeys(self.axis(1))

    def test_a_client_that_never_reads_its_answers_harms_nobody(self):
        self.start()
        self.set_running(self.axis(1))
        with socket.create_connection(("127.0.0.1", self.ports[0]), timeout=NEVER) as deaf:
            deaf.setblocking(False)

            def look():
                self.assertEqual(self.client.gateway()["axes_online"], 2)
                try:
                    for number in range(1000):
                        deaf.send(read_request(number, 100, 90))
                except BlockingIOError:
                    pass
                except (BrokenPipeError, ConnectionResetError):
                    return True
                return False

            until("it is cut off", look)
        self.assert_obeys(self.axis(1))


class AllowList(Story):
    def role(self, role):
        self.start([self.listener(), self.listener(allow=[{"from": "127.0.0.0/8", "role": role}])])
        return Axis(self.connect(1), 1)

    def assert_may_not(self, work):
        with self.refused(NO_FUNCTION):
            work()

    def test_a_viewer_reads_and_writes_nothing(self):
        axis = self.role("viewer")
        self.assertEqual(axis.client.gateway()["role"], 1)
        self.assertEqual(axis.get("link_state"), 2)
        writes = self.sim.writes("lift/1")
        for work in (lambda: axis.set(target_velocity=5), lambda: axis.set(controlword=6), lambda: axis.command("enable"),
                     lambda: axis.coil("quick_stop"), lambda: axis.set(position_limit_min=5), lambda: axis.set(position_actual=5)):
            self.assert_may_not(work)
        self.assertEqual(self.sim.writes("lift/1"), writes)
        axis.client.write(8, 77)  # the heartbeat is everybody's
        axis.set(object_index=0x6041, object_subindex=0, object_size=2)
        axis.set(object_request=1)
        axis.until(object_status=2)
        self.assert_may_not(lambda: axis.set(object_request=2))

    def test_an_operator_moves_and_sets_no_limits(self):
        axis = self.role("operator")
        self.assertEqual(axis.client.gateway()["role"], 2)
        axis.command("enable")
        axis.command("disable")
        for work in (lambda: axis.set(position_limit_min=-5), lambda: axis.set(max_velocity=5 * RPM),
                     lambda: axis.command("save_parameters"), lambda: axis.set(object_request=2)):
            self.assert_may_not(work)

    def test_an_engineer_may_all(self):
        axis = self.role("engineer")
        axis.set(max_velocity=2000 * RPM)
        self.assertEqual(self.sim.object("lift/1", "6080.00"), 2000)
        axis.command("save_parameters")

    def test_an_address_it_does_not_name_is_closed_at_once(self):
        self.start([self.listener(), self.listener(allow=[{"from": "127.0.0.2", "role": "operator"}])])
        with self.assertRaises(Closed):
            self.connect(1).registers(0)
        named = ModbusTcpClient("127.0.0.1", port=self.ports[1], timeout=NEVER, source_address=("127.0.0.2", 0))
        self.assertTrue(named.connect())
        self.addCleanup(named.close)
        self.assertEqual(named.read_holding_registers(7, 1, slave=1).registers, [2])


if __name__ == "__main__":
    main()
