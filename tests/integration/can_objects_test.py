# SPDX-License-Identifier: Apache-2.0
"""FC 43/13: any object of any drive, as the maker's own tools would ask for it, by bytes over a plain socket."""
import socket
import struct
import unittest

from can_stage import ON_VCAN, RPM, TURN, CanStory, main
from modbus import BUSY, NO_ANSWER, NO_PATH, OFFLINE, ONLINE
from processes import NEVER, until
from stage import Story

READ, WRITE, MORE_FOLLOWS = 0, 1, 0x80
NO_OBJECT, READ_ONLY, GENERAL = 0x06020000, 0x06010002, 0x08000000


class Objects:
    """What both kinds of line need: requests by 43/13."""

    def general(self, node, index, sub=0, data=b"", count=0, access=READ, start=0):
        """The answer's PDU."""
        return self.ask_raw(struct.pack(">BBBBBHBHH", 0x2B, 0x0D, access, 0, node, index, sub, start, count or len(data)) + data)

    def ask_raw(self, pdu):
        if not hasattr(self, "raw"):
            self.raw = socket.create_connection(("127.0.0.1", self.ports[0]), timeout=NEVER)
            self.addCleanup(self.raw.close)
        self.raw.sendall(struct.pack(">HHHB", 13, 0, len(pdu) + 1, 1) + pdu)
        number, protocol, length, unit = struct.unpack(">HHHB", self.raw.recv(7, socket.MSG_WAITALL))
        self.assertEqual((number, protocol, unit), (13, 0, 1))
        return self.raw.recv(length - 1, socket.MSG_WAITALL)

    def read(self, node, index, sub=0, start=0, count=0, follows=False):
        answer = self.general(node, index, sub, start=start, count=count)
        flags = MORE_FOLLOWS if follows else READ
        self.assertEqual(answer[:10], struct.pack(">BBBBBHBH", 0x2B, 0x0D, flags, 0, node, index, sub, start), answer.hex(" "))
        length, = struct.unpack(">H", answer[10:12])
        self.assertEqual(len(answer), 12 + length)
        return answer[12:]

    def write(self, node, index, sub, data):
        answer = self.general(node, index, sub, data, access=WRITE)
        self.assertEqual(answer, struct.pack(">BBBBBHBHH", 0x2B, 0x0D, WRITE, 0, node, index, sub, 0, 0), answer.hex(" "))

    def assert_aborted(self, answer, code):
        self.assertEqual(answer, bytes.fromhex("ABFF00060DCE") + struct.pack(">I", code), answer.hex(" "))

    def number(self, node, index, sub=0):
        return int.from_bytes(self.read(node, index, sub), "little", signed=True)


class OnCan(Objects, CanStory):
    def setUp(self):
        super().setUp()
        self.begin()

    def test_each_drive_tells_its_name(self):
        for number, name in ((1, "LD2-CAN7010"), (2, "JD620"), (3, "MD60")):  # two in segments, one in a single frame
            self.assertEqual(self.read(number, 0x1008), name.encode())

    def test_the_exact_bytes_of_a_read(self):
        name = self.ask("get DRIVE 1008.00", 1).encode()
        answer = self.general(1, 0x1008)
        self.assertEqual(answer, bytes.fromhex("2B 0D 00 00 01 10 08 00 00 00") + struct.pack(">H", len(name)) + name)

    def test_a_long_name_in_pieces(self):
        whole = self.read(1, 0x1008)
        self.assertEqual(self.read(1, 0x1008, count=3, follows=True), whole[:3])
        self.assertEqual(self.read(1, 0x1008, start=3, count=4, follows=True), whole[3:7])
        self.assertEqual(self.read(1, 0x1008, start=7), whole[7:])

    def test_the_statusword_is_the_one_of_the_register(self):
        for axis in self.axes:
            self.assertEqual(self.number(axis.number, 0x6041) & 0xFFFF, axis.get("statusword"))

    def test_a_write_reaches_the_drive_and_the_register(self):
        for axis in self.axes:
            with self.subTest(axis=axis.number):
                per_turn = 65536 if axis.number == 3 else 10000
                self.write(axis.number, 0x607A, 0, struct.pack("<i", 2 * per_turn))
                self.assertEqual(int(self.ask("get DRIVE 607A.00", axis.number).split()[0]), 2 * per_turn)
                until("the register", lambda: axis.get("target_position") == 2 * TURN)

    def test_what_a_drive_refuses_comes_with_its_abort_code(self):
        for number in (1, 2, 3):
            with self.subTest(axis=number):
                self.assert_aborted(self.general(number, 0x6041, 0, bytes(2), access=WRITE), READ_ONLY)
                self.assert_aborted(self.general(number, 0x5FFE), NO_OBJECT)
                self.assertEqual(self.axes[number - 1].get("link_state"), ONLINE)

    def test_a_node_that_is_not_there_and_one_that_is_gone(self):
        self.assertEqual(self.general(9, 0x1008)[:1], b"\xAB")
        self.ask("connect DRIVE off", 2)
        self.axes[1].until(link_state=OFFLINE)
        self.assertEqual(self.general(2, 0x1008), bytes([0xAB, NO_PATH]))
        self.assertEqual(self.read(1, 0x1008).decode(), self.ask("get DRIVE 1008.00", 1))

    def test_a_drive_that_answers_nothing_any_more(self):
        self.ask("unresponsive DRIVE on", 1)
        answer = self.general(1, 0x1008)
        self.assertIn(answer, (bytes([0xAB, NO_ANSWER]), bytes([0xAB, NO_PATH])), answer.hex(" "))
        self.ask("clear DRIVE", 1)
        self.axes[0].until(link_state=ONLINE)
        self.assertEqual(self.read(1, 0x1008).decode(), self.ask("get DRIVE 1008.00", 1))
        self.assert_one_request_at_a_time()


class StopsGoFirst(Objects, CanStory):
    """A long object is many exchanges; a stop for the same drive does not wait for its end."""

    def test_a_quick_stop_ends_a_long_read(self):
        self.begin()
        for axis in self.axes[:2]:
            self.prepare(axis)
            axis.command("enable")
            axis.set(target_velocity=300 * RPM)
            axis.command("run_velocity")
            until("it runs", lambda: axis.get("velocity_actual") > 200 * RPM)
            name = self.read(axis.number, 0x1008)
            self.ask("reply-delay LINE 80")
            exchanges = int(self.ask("exchanges LINE"))
            reading = self.later(self.general, axis.number, 0x1008)
            until("it has begun", lambda: int(self.ask("exchanges LINE")) > exchanges + 1)
            axis.command("quick_stop")
            self.ask("reply-delay LINE 1")
            answer = reading.result(timeout=NEVER)
            self.assertIn(answer, (bytes([0xAB, BUSY]), answer[:10] + struct.pack(">H", len(name)) + name), answer.hex(" "))
            until("it stands", lambda: abs(axis.get("velocity_actual")) <= RPM)
            self.assertEqual(self.read(axis.number, 0x1008), name)
            axis.command("disable")
        self.assert_one_request_at_a_time()


@unittest.skipIf(ON_VCAN, "serial lines need no CAN interface")
class OnASerialLine(Objects, Story):
    """Kinco's own protocol: the same request, its refusals as CiA 309 has them for other protocols."""

    def setUp(self):
        super().setUp()
        self.start()

    def test_read_write_and_refused(self):
        axis = self.axis(1)
        self.assertEqual(self.number(1, 0x6041) & 0xFFFF, axis.get("statusword"))
        self.write(1, 0x607A, 0, struct.pack("<i", 2 * TURN))
        self.assertEqual(self.sim.object("lift/1", "607A.00"), 2 * TURN)
        self.assert_aborted(self.general(1, 0x6041, 0, bytes(2), access=WRITE), GENERAL)
        detail = self.ask_raw(struct.pack(">BHH", 3, 126, 2))  # of this very client
        self.assertEqual(int.from_bytes(detail[2:], "big"), READ_ONLY, "the drive's own code is kept")


if __name__ == "__main__":
    main()
