# SPDX-License-Identifier: Apache-2.0
"""object_request: any object of any drive, by index and subindex, as axes know them."""
from dds_stage import DONE, REFUSED_BY_DRIVE, VENDORS, DdsStory, main

NO_OBJECT, READ_ONLY = 0x06020000, 0x06010002


class Asked(DdsStory):
    def setUp(self):
        super().setUp()
        self.begin()

    def each_asker(self):
        for vendor in VENDORS:
            peer = self.peer_of(vendor)
            peer.ask_objects()
            self.at = peer.name
            yield peer
            peer.leave()
        self.at = None


class Objects(Asked):
    lease = None

    def assert_number(self, reply, value, size):
        self.assertEqual((reply["result"], reply["detail"]), (DONE, 0), reply)
        self.assertEqual(reply["value"], value)
        self.assertEqual(reply["data"], value.to_bytes(size, "little").hex())

    def test_numbers_are_read_and_written(self):
        for peer in self.each_asker():
            for number, where in ((1, "serial/1"), (2, "leadshine/1")):
                for index, size, value in ((0x6081, 4, 123456), (0x6060, 1, 3), (0x6060, 1, 1)):
                    written = peer.object(number, index, write=1, size=size, value=value)
                    self.assertEqual((written["result"], written["axis"]), (DONE, number), written)
                    self.assertEqual(self.sim.object(where, f"{index:04X}.00"), value)
                    self.assert_number(peer.object(number, index, size=size), value, size)
                self.assert_number(peer.object(number, 0x6041, size=2), self.sim.object(where, "6041.00"), 2)

    def test_a_text_of_any_length_is_read(self):
        for peer in self.each_asker():
            reply = peer.object(2, 0x1008)
            self.assertEqual((reply["result"], bytes.fromhex(reply["data"])), (DONE, b"LD2-CAN7010"))

    def test_what_is_refused_tells_the_abort_code(self):
        for peer in self.each_asker():
            for members, detail in (({"index": 0x5FFF, "size": 2}, NO_OBJECT),
                                    ({"index": 0x6041, "size": 2, "write": 1, "value": 1}, READ_ONLY)):
                reply = peer.object(2, **members)
                self.assertEqual((reply["result"], reply["detail"]), (REFUSED_BY_DRIVE, detail), reply)
                self.assertEqual((reply["value"], reply["data"]), (0, ""))
            self.assertEqual(peer.object(1, 0x5FFF, size=2)["result"], REFUSED_BY_DRIVE)


if __name__ == "__main__":
    main()
