# SPDX-License-Identifier: Apache-2.0
"""object_request: any object of any drive, by index and subindex, as axes know them."""
from dds_stage import BAD_VALUE, DONE, NO_AXIS, NOT_OWNER, REFUSED_BY_DRIVE, SEEN, VENDORS, DdsStory, main
from lease_stage import ME, NOBODY
from modbus import Axis

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

    def test_what_makes_no_sense_is_refused(self):
        for peer in self.each_asker():
            self.assertEqual(peer.object(77, 0x6041, size=2)["result"], NO_AXIS)
            self.assertEqual(peer.object(1, 0x6041, size=3)["result"], BAD_VALUE)
            self.assertEqual(peer.object(2, 0x6081, write=1, size=0)["result"], BAD_VALUE)
            request = peer.write("object_request", request_id=0, axis=1, index=0x6041, size=2)
            self.assertEqual(peer.answer(request, topic="object_reply")[0], BAD_VALUE)
            first = peer.write("object_request", axis=1, index=0x6041, size=2)
            self.assertEqual(peer.answer(first, topic="object_reply")[0], DONE)
            since = peer.now()
            peer.write("object_request", first, axis=1, index=0x6041, size=2)
            self.assertEqual(peer.answer(first, since, "object_reply")[0], SEEN)


class Owned(Asked):
    def test_an_object_of_an_axis_that_another_owns_is_read_and_not_written(self):
        owner = Axis(self.peer(), 2)
        owner.set(target_velocity=1000)
        before = self.sim.object("leadshine/1", "6083.00")
        for peer in self.each_asker():
            owner.client.gateway()
            self.assertEqual(peer.object(2, 0x6083, write=1, size=4, value=4711)["result"], NOT_OWNER)
            self.assertEqual(self.sim.object("leadshine/1", "6083.00"), before)
            self.assertEqual(peer.object(2, 0x6083, size=4)["result"], DONE)
            self.assertEqual(owner.get("owner"), ME)

    def test_whoever_commands_an_axis_writes_its_objects_too(self):
        for vendor in self.each_vendor():
            peer = self.commander(vendor)
            peer.ask_objects()
            peer.do(2, "enable")
            self.assertEqual(peer.object(2, 0x6083, write=1, size=4, value=4711)["result"], DONE)
            self.assertEqual(self.sim.object("leadshine/1", "6083.00"), 4711)
            self.let_go(peer, 2)
            self.watched(2).until(owner=NOBODY)
            peer.leave()


class Operators(Asked):
    dds = {"role": "operator"}

    def test_operators_read_objects_and_write_none(self):
        for peer in self.each_asker():
            self.assertEqual(peer.object(2, 0x6083, size=4)["result"], DONE)
            self.assertEqual(peer.object(2, 0x6083, write=1, size=4, value=4711)["result"], 18)


if __name__ == "__main__":
    main()
