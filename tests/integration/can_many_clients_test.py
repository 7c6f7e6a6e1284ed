# SPDX-License-Identifier: Apache-2.0
"""32 clients on two drives of one CAN bus: each gets its own right answers, and the bus carries one request at a time."""
from can_stage import CanStory, main
from modbus import BUSY, ONLINE, SUSPECT, Client, Refused
from processes import NEVER, until

ROUNDS = 8
# One writer for each row of each axis; with three who ask for objects they are as many as may wait for one axis.
ROWS = ["target_position", "profile_velocity", "profile_acceleration", "homing_speed_switch", "homing_speed_zero"]
# What only this drive answers so: the makers' numbers, the gateway's heartbeat, the encoder.
OBJECTS = {1: {(0x1018, 1, 4): 0x4321, (0x608F, 1, 4): 10000, (0x1017, 0, 2): 1000},
           2: {(0x1018, 1, 4): 0x300, (0x1016, 1, 4): 127 << 16 | 1500, (0x1800, 1, 4): 0x182}}


class ThirtyTwoClients(CanStory):
    drives_on = {"cell": "ld2@1,jd@2"}
    timings = {"timeout_ms": 5000}

    def work(self, what, *arguments):
        client = Client(self.ports[0])
        try:
            return what(client, *arguments)
        finally:
            client.close()

    def write_row(self, client, number, name):
        """Its own row, again and again; each answer is followed by a read that must show it."""
        axis = client.axis(number)
        for turn in range(1, ROUNDS + 1):
            value = 65537 * turn  # both words are the same number
            axis.set(**{name: value})
            shown = axis.get(name)
            assert abs(shown - value) <= 400, f"{name} of axis {number}: wrote {value}, read {shown}"
            assert axis.get("command_result") == 2
        return 65537 * ROUNDS

    def read_objects(self, client, number):
        axis = client.axis(number)
        for _ in range(ROUNDS):
            for (index, sub, size), right in OBJECTS[number].items():
                axis.client.write(axis.first + 81, index, sub, size)
                axis.set(object_request=1)
                block = until("the object", lambda: (now := axis.block())["object_status"] in (2, 3) and now)
                assert block["object_status"] == 2, f"{index:04X}:{sub:02X} failed: {block['object_detail']:#x}"
                assert block["object_data"] == right, f"{index:04X}:{sub:02X} of axis {number} is said to be {block['object_data']:#x}"

    def read_everything(self, client, number):
        for _ in range(5 * ROUNDS):
            block = client.axis(number).block()
            assert block["link_state"] in (ONLINE, SUSPECT), block["link_state"]
            assert block["profile_velocity"] != 0xFFFFFFFF, "a value that was known is known"
            assert client.gateway()["word_order_test"] == 0x01020304
            assert client.overview(number)["link_state"] in (ONLINE, SUSPECT)

    def test_all_are_answered_rightly(self):
        self.begin()
        written_before = {number: int(self.ask("writes DRIVE 6083.00", number)) for number in (1, 2)}
        writers = {(number, name): self.later(self.work, self.write_row, number, name) for number in (1, 2) for name in ROWS}
        askers = [self.later(self.work, self.read_objects, number) for number in (1, 2) for _ in range(3)]
        readers = [self.later(self.work, self.read_everything, 1 + index % 2) for index in range(16)]
        self.assertEqual(len(writers) + len(askers) + len(readers), 32)
        for work in [*readers, *askers, *writers.values()]:
            work.result(timeout=NEVER)
        for (number, name), writer in writers.items():
            with self.subTest(axis=number, row=name):
                self.assertAlmostEqual(self.axis(number).get(name), writer.result(), delta=400)
        for number in (1, 2):
            written = int(self.ask("writes DRIVE 6083.00", number)) - written_before[number]
            self.assertEqual(written, ROUNDS, "each write reached the drive once")
        self.assert_one_request_at_a_time()
        counts = self.client.bus(0)
        self.assertEqual((counts["timeouts"], counts["late_replies"], counts["bad_frames"]), (0, 0, 0))

    def write_until_answered(self, client, number, name):
        busy = 0
        for turn in range(1, ROUNDS + 1):
            try:
                client.axis(number).set(**{name: 65537 * turn})
            except Refused as refused:
                assert refused.code == BUSY, refused
                busy += 1
        return busy

    def test_more_than_may_wait_are_told_so(self):
        self.begin()
        self.ask("reply-delay LINE 30")
        writers = [self.later(self.work, self.write_until_answered, number, name)
                   for number in (1, 2) for name in ROWS for _ in range(3)]
        self.assertGreater(sum(work.result(timeout=NEVER) for work in writers), 0, "nobody was told to come again")
        self.ask("reply-delay LINE 1")
        self.assert_one_request_at_a_time()
        for number in (1, 2):
            self.axis(number).until(link_state=ONLINE)
            self.axis(number).set(profile_velocity=100000)
            self.assertAlmostEqual(self.axis(number).get("profile_velocity"), 100000, delta=10)


if __name__ == "__main__":
    main()
