# SPDX-License-Identifier: Apache-2.0
"""A user's first minutes: both axes are there, every address that `axisgate map` prints is there, in every view."""
import json

from pymodbus.constants import DeviceInformation
from pymodbus.mei_message import ReadDeviceInformationRequest
from pymodbus.register_read_message import ReadWriteMultipleRegistersRequest
from pymodbus.register_write_message import MaskWriteRegisterRequest

from modbus import AXIS, NO_ADDRESS, NO_PATH, encode, mbpoll, width
from stage import Story, main

FLAT, LOW_FIRST, PER_AXIS = range(3)


class FirstContact(Story):
    def setUp(self):
        super().setUp()
        self.start([self.listener(), self.listener(word_order="low-first"), self.listener(unit_ids="per-axis")])

    def listed(self):
        done = self.command_line("map", self.config, "--format", "json")
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def test_a_scanner_reads_both_axes(self):
        for number in (1, 2):
            with self.subTest(axis=number):
                block = self.axis(number).block()
                self.assertEqual(block["link_state"], 2)
                self.assertEqual(block["position_actual"], 0)
                self.assertEqual(block["error_code"], 0)
                self.assertEqual(block["axis_state"], 0)
                self.assertEqual(block["statusword"] & 0x0C, 0, "enabled by itself, or faulted")
                self.assertLess(block["age_ms"], 60000)
                for bit, name in enumerate(["statusword", "mode_display", "position_actual", "velocity_actual"]):
                    self.assertTrue(block["supported"] >> bit & 1, name)
                    self.assertTrue(block["valid"] >> bit & 1, name)
                self.assertEqual(block["valid"] & ~block["supported"], 0)
                self.assertEqual(self.axis(number).inputs() & {"online", "ready", "enabled", "fault"}, {"online", "ready"})

    def test_mbpoll_and_pymodbus_read_the_same(self):
        self.axis(1).set(target_position=-123456)
        self.assertEqual(mbpoll(self.ports[FLAT], "4:int", 142), [-123456])
        self.assertEqual(mbpoll(self.ports[FLAT], "3:int", 142), [-123456])
        self.assertEqual(mbpoll(self.ports[FLAT], "4", 118), [2])
        self.assertEqual(mbpoll(self.ports[FLAT], "1", 100, count=3), [1, 1, 0])
        self.assertEqual(len(mbpoll(self.ports[FLAT], "4", 100, count=39)), 39)

    def test_the_overview_shows_all_axes_in_one_read(self):
        registers = self.client.registers(60010, 20)
        self.assertEqual([registers[8], registers[18]], [2, 2])
        for number in (1, 2):
            self.assertEqual(self.client.overview(number)["statusword"], self.axis(number).get("statusword"))

    def test_the_gateway_tells_of_itself(self):
        gateway = self.client.gateway()
        self.assertEqual((gateway["map_version"], gateway["axis_count"], gateway["axes_online"]), (1, 2, 2))
        self.assertEqual(gateway["gateway_state"], 1)
        self.assertEqual(gateway["role"], 3, "a client on this machine is an engineer")
        self.assertEqual(gateway["word_order_test"], 0x01020304)

    def test_each_bus_counts_its_traffic(self):
        for number in (0, 1):
            earlier = self.client.bus(number)
            self.assertEqual(earlier["link"], 1)
            self.assertEqual((earlier["timeouts"], earlier["bad_frames"], earlier["late_replies"]), (0, 0, 0))
            later = self.client.bus(number)
            self.assertGreaterEqual(later["requests"], earlier["requests"])
            self.assertGreater(later["replies"], 0)
            self.assertLessEqual(later["requests"] - later["replies"], 1, "more than one request outstanding")
        with self.refused(NO_ADDRESS):
            self.client.registers(50200)

    def test_low_word_first_turns_every_32_bit_value(self):
        self.axis(1).set(target_position=123456)
        low_first = self.connect(LOW_FIRST)
        self.assertEqual(low_first.registers(10, 2), [0x0304, 0x0102])
        self.assertEqual(low_first.registers(142, 2), [123456 & 0xFFFF, 123456 >> 16])
        low_first.write(142, 0xFFFF & -70000, 0xFFFF & (-70000 >> 16))
        self.assertEqual(self.axis(1).get("target_position"), -70000)
        self.assertEqual(self.sim.object("lift/1", "607A.00"), -70000)

    def test_a_unit_is_an_axis_where_the_listener_says_so(self):
        self.axis(2).set(target_position=10000)
        second = self.connect(PER_AXIS, unit=2)
        self.assertEqual(second.axis(0).get("target_position"), 10000)
        self.assertIn("online", second.axis(0).inputs())
        self.assertEqual(self.connect(PER_AXIS, unit=255).axis(2).get("target_position"), 10000)
        with self.refused(NO_PATH):
            self.connect(PER_AXIS, unit=3).registers(2)

    def test_one_request_writes_reads_and_masks(self):
        target, method = (100 + AXIS[name][0] for name in ("target_position", "homing_method"))
        reply = self.client.execute(ReadWriteMultipleRegistersRequest(
            read_address=target, read_count=2, write_address=target, write_registers=encode("i32", -40000), unit=1))
        self.assertEqual(reply.registers, encode("i32", -40000), "it reads what its write has done")
        self.assertEqual(self.sim.object("lift/1", "607A.00"), -40000)
        self.axis(1).set(homing_method=17)
        self.client.execute(MaskWriteRegisterRequest(method, and_mask=0x00F0, or_mask=0x0003, unit=1))
        self.assertEqual((self.axis(1).get("homing_method"), self.sim.object("lift/1", "6098.00")), (0x13, 0x13))

    def test_it_identifies_itself_on_all_levels(self):
        def read(level, first=0):
            return self.client.execute(ReadDeviceInformationRequest(read_code=level, object_id=first, unit=1)).information

        basic, regular = read(DeviceInformation.Basic), read(DeviceInformation.Regular)
        self.assertEqual(basic[0], b"axisgate")
        self.assertEqual(sorted(basic), [0, 1, 2])
        self.assertLess(set(basic), set(regular))
        self.assertLess(set(regular), set(read(DeviceInformation.Extended)))
        self.assertEqual(read(DeviceInformation.Specific, 2)[2], basic[2])

    def test_map_tells_as_which_listener_shows_it(self):
        flat, low_first, per_axis = (f"127.0.0.1:{port}" for port in self.ports)
        for listener, order in ((flat, "high-first"), (low_first, "low-first"), (per_axis, "high-first")):
            with self.subTest(listener=listener):
                done = self.command_line("map", self.config, "--format", "json", "--listener", listener)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual(json.loads(done.stdout)["word_order"], order)
                for other in {flat, low_first, per_axis} - {listener}:
                    self.assertIn(f"{other} shows it otherwise", done.stderr)
                self.assertEqual("unit N shows axis N alone" in done.stderr, listener == per_axis)
        done = self.command_line("map", self.config, "--listener", "127.0.0.1:1")
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn(f"{self.config}: /modbus_tcp: no listener has", done.stderr)

    def test_every_address_that_map_prints_is_served(self):
        listing = self.listed()
        self.assertEqual((listing["map_version"], listing["word_order"]), (1, "high-first"))
        self.assertGreater(len(listing["entries"]), 200)
        reads = {"holding": self.client.registers, "coil": self.read_coils, "discrete": self.read_inputs}
        for entry in listing["entries"]:
            with self.subTest(entry=entry["name"], address=entry["address"]):
                self.assertEqual(len(reads[entry["table"]](entry["address"], entry["count"])), entry["count"])

    def test_map_names_what_the_contract_names(self):
        rows = {entry["name"]: entry for entry in self.listed()["entries"] if entry["table"] == "holding" and entry["axis"] == 1
                and entry["address"] < 50000}
        for name, (offset, kind) in AXIS.items():
            with self.subTest(name):
                self.assertEqual((rows[name]["address"], rows[name]["type"], rows[name]["count"]), (100 + offset, kind, width(kind)))

    def test_what_map_does_not_print_is_not_there(self):
        served = set()
        for entry in self.listed()["entries"]:
            if entry["table"] == "holding":
                served |= set(range(entry["address"], entry["address"] + entry["count"]))
        for address in (99, 199, 299):  # unlisted, inside a block: 0
            self.assertNotIn(address, served)
            self.assertEqual(self.client.registers(address), [0])
        for address in (300, 5000, 49900, 50200, 60030, 65535):
            self.assertNotIn(address, served)
            with self.refused(NO_ADDRESS):
                self.client.registers(address)

    def test_writable_and_read_only_rows_are_as_map_prints_them(self):
        for entry in self.listed()["entries"]:
            if entry["table"] != "holding" or entry["access"] != "r":
                continue
            with self.subTest(entry=entry["name"], address=entry["address"]), self.refused(NO_ADDRESS):
                self.client.write(entry["address"], *[0] * entry["count"])

    def read_coils(self, address, count):
        return self.client.ask(self.client.tcp.read_coils, address, count).bits[:count]

    def read_inputs(self, address, count):
        return self.client.ask(self.client.tcp.read_discrete_inputs, address, count).bits[:count]

    def test_another_configuration_on_the_same_port_is_refused_and_names_the_port(self):
        second = self.command_line("run", self.config)
        self.assertEqual(second.returncode, 1)
        self.assertIn(f"127.0.0.1:{self.ports[0]}", second.stderr)
        self.assertIn("another program has it", second.stderr)


if __name__ == "__main__":
    main()
