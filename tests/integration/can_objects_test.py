# SPDX-License-Identifier: Apache-2.0
"""FC 43/13: any object of any drive, as the maker's own tools would ask for it, by bytes over a plain socket."""
import socket
import struct

from can_stage import TURN, CanStory, main
from modbus import NO_PATH, OFFLINE, ONLINE
from processes import NEVER
from stage import Story

READ, WRITE = 0, 1
NO_OBJECT, READ_ONLY, GENERAL = 0x06020000, 0x06010002, 0x08000000


class Objects:
    """What both kinds of line need: requests by 43/13."""

    def general(self, node, index, sub=0, data=b"", access=READ):
        """The answer's PDU."""
        return self.ask_raw(struct.pack(">BBBBBHBHH", 0x2B, 0x0D, access, 0, node, index, sub, 0, len(data)) + data)

    def ask_raw(self, pdu):
        if not hasattr(self, "raw"):
            self.raw = socket.create_connection(("127.0.0.1", self.ports[0]), timeout=NEVER)
            self.addCleanup(self.raw.close)
        self.raw.sendall(struct.pack(">HHHB", 13, 0, len(pdu) + 1, 1) + pdu)
        number, protocol, length, unit = struct.unpack(">HHHB", self.raw.recv(7, socket.MSG_WAITALL))
        self.assertEqual((number, protocol, unit), (13, 0, 1))
        return self.raw.recv(length - 1, socket.MSG_WAITALL)

    def read(self, node, index, sub=0):
        answer = self.general(node, index, sub)
        self.assertEqual(answer[:10], struct.pack(">BBBBBHBH", 0x2B, 0x0D, READ, 0, node, index, sub, 0), answer.hex(" "))
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
