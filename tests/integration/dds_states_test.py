# SPDX-License-Identifier: Apache-2.0
"""axis_state and gateway_state: what subscribers of both vendors read is what the registers show."""
import math
import time
from fractions import Fraction

from dds_stage import RPM, VENDORS, DdsStory, main
from modbus import AXIS, BUS, ONLINE, Axis
from processes import until

PI = Fraction("3.14159265358979323846264338327950288419716939937510")
AS_IT_IS = {"statusword": "statusword", "mode": "mode_display", "error_code": "error_code", "vendor_error": "vendor_error",
            "inputs": "digital_inputs", "outputs": "digital_outputs", "axis_state": "axis_state", "motion_state": "motion_state",
            "motion_id": "motion_id", "alarms": "axis_alarms", "link_state": "link_state", "supported": "supported", "valid": "valid"}
# Units of a register, in SI.
SCALED = {"position": ("position_actual", 2 * PI / 10000), "velocity": ("velocity_actual", 2 * PI / 60000),
          "following_error": ("following_error", 2 * PI / 10000), "torque": ("torque_actual", Fraction(1)),
          "current": ("current_actual", Fraction(1, 100)), "drive_temperature": ("drive_temperature", Fraction(1, 10)),
          "motor_temperature": ("motor_temperature", Fraction(1, 10)), "voltage": ("dc_voltage", Fraction(1, 10))}
NO_VALUE = {"i16": -0x8000, "u16": 0xFFFF, "i32": -0x80000000, "u32": 0xFFFFFFFF}


def si(register, value):
    name, unit = SCALED[register]
    return math.nan if value == NO_VALUE[AXIS[name][1]] else float(value * unit)


class Watched(DdsStory):
    """A reader of each vendor."""

    topic = "axis_state"

    def setUp(self):
        super().setUp()
        self.begin()
        self.readers = [self.peer_of(vendor).read(self.topic) for vendor in VENDORS]

    def each_reader(self):
        for reader in self.readers:
            self.at = reader.name
            yield reader
        self.at = None

    def assert_same(self, sample, block):
        self.assertEqual({name: sample[name] for name in AS_IT_IS}, {name: block[register] for name, register in AS_IT_IS.items()})
        for name, (register, _) in SCALED.items():
            wanted = si(name, block[register])
            if math.isnan(wanted):
                self.assertTrue(math.isnan(sample[name]), f"{name}: {sample[name]}, and the register stands for no value")
            else:
                self.assertEqual(sample[name], wanted, name)

    def newest(self, reader, number, **where):
        """The sample that shows what the registers show at last."""
        def look():
            block = self.registers(number)
            samples = reader.samples("axis_state", max(0, reader.now() - 100), axis=number,
                                     **{name: value for name, value in where.items() if name in AS_IT_IS})
            same = [sample for sample in samples if sample["sequence_number"] & 0xFFFF == block["sequence"]]
            return (same[-1], block) if same else None

        return until(f"axis {number} is seen as it is", look)


class Values(Watched):
    dds = {"min_period_ms": 1}

    def test_while_motors_turn_each_sample_is_one_snapshot_of_the_registers(self):
        master = self.peer()
        for number in self.numbers:
            self.set_running(Axis(master, number), rpm=300 if number == 1 else -200)
        for number in self.numbers:
            blocks = {}
            for reader in self.each_reader():
                since = reader.now()

                def of_one_moment(reader=reader, since=since, number=number, blocks=blocks):
                    master.gateway()
                    block = self.registers(number)
                    blocks[block["sequence"]] = block
                    found = [(sample, blocks[sample["sequence_number"] & 0xFFFF])
                             for sample in reader.samples("axis_state", since, axis=number)
                             if sample["sequence_number"] & 0xFFFF in blocks]
                    return found if len({sample["position"] for sample, _ in found}) >= 10 else None

                for sample, block in until("samples and registers of one moment", of_one_moment):
                    self.assert_same(sample, block)
                self.assertEqual(sample["name"], self.motors[number][0])
                self.assertGreater(sample["velocity"] * (1 if number == 1 else -1), 100 * RPM)

    def test_an_axis_without_values_is_shown_as_such(self):
        for reader in self.each_reader():
            sample, block = self.newest(reader, 1)
            self.assert_same(sample, block)
            self.assertTrue(math.isnan(sample["motor_temperature"]), "a JD has no such sensor")

    def test_numbers_of_samples_only_rise(self):
        self.set_running(Axis(self.peer(), 2))
        for reader in self.each_reader():
            until("many samples", lambda reader=reader: len(reader.samples("axis_state", axis=2)) > 50)
            numbers = [sample["sequence_number"] for sample in reader.samples("axis_state", axis=2)]
            self.assertEqual(numbers, sorted(numbers))
            stamps = [(sample["stamp"]["sec"], sample["stamp"]["nanosec"]) for sample in reader.samples("axis_state", axis=2)]
            self.assertEqual(stamps, sorted(stamps))
            self.assertLess(abs(stamps[-1][0] - time.time()), 60, "a stamp is the time of day")


class Seldom(Watched):
    """Nothing is sent that nobody asked for."""

    dds = {"min_period_ms": 200, "max_period_ms": 600000}

    def test_only_changes_are_sent_and_not_more_often_than_configured(self):
        begun = time.monotonic()
        master = Axis(self.peer(), 1)
        self.set_running(master)
        self.keep_running(master.client, [1], 1.5)
        for reader in self.each_reader():
            self.newest(reader, 1)
            samples = reader.samples("axis_state", axis=1)
            most = (time.monotonic() - begun) / 0.2
            self.assertLess(len(samples), most + 5, "of one axis")
            numbers = [sample["sequence_number"] for sample in samples]
            self.assertEqual(len(numbers), len(set(numbers)), "the same state came twice")
            self.assertGreater(numbers[-1] - numbers[0], 2 * len(numbers), "the states between were left out")

    def test_a_late_joiner_gets_the_last_state_of_every_axis(self):
        master = Axis(self.peer(), 1)
        master.set(target_velocity=1000)  # owned: a change that comes once
        for reader in self.each_reader():
            self.newest(reader, 1)
        for vendor in self.each_vendor():
            late = self.peer_of(vendor).read("axis_state")
            for number in self.numbers:
                self.assertEqual(late.sample("axis_state", axis=number)["name"], self.motors[number][0])
                self.assert_same(*self.newest(late, number))


class Often(Watched):
    dds = {"min_period_ms": 10, "max_period_ms": 100}
    lines_of = ("serial",)

    def test_an_axis_that_does_not_change_is_told_again_and_again(self):
        for reader in self.each_reader():
            def five_of_one_number(reader=reader):
                numbers = [sample["sequence_number"] for sample in reader.samples("axis_state", axis=1)]
                return any(numbers.count(number) >= 5 for number in set(numbers[-20:]))

            until("the same state five times", five_of_one_number)


class Unplugged(Watched):
    def test_a_drive_that_is_gone_keeps_its_instance_and_its_last_values(self):
        places = [reader.now() for reader in self.readers]
        for line, number in (("serial", 1), ("leadshine", 2)):
            _, before = self.newest(self.readers[0], number, link_state=ONLINE)
            self.sim.ask(f"unplug {line}")
            until("it is seen to be gone", lambda number=number: self.registers(number)["link_state"] > 3)
            for reader in self.each_reader():
                sample, block = self.newest(reader, number)
                self.assert_same(sample, block)
                self.assertEqual(sample["valid"] & 0b100, 0)
                self.assertEqual(sample["statusword"], 0)
                self.assertAlmostEqual(sample["position"], si("position", before["position_actual"]), delta=0.1)
            self.sim.ask(f"plug {line}")
            self.watched(number).until(link_state=ONLINE)
            for reader in self.each_reader():
                reader.sample("axis_state", lambda data: data["valid"] & 0b100, since=places[0], axis=number, link_state=ONLINE)
        for reader, place in zip(self.readers, places):
            self.assertEqual(reader.all("instance", "axis_state", since=place), [], "disposed, or without a writer")
            self.assertEqual({told["state"] for told in reader.all("sample", "axis_state", since=place)}, {"alive"})


class Gateway(Watched):
    topic = "gateway_state"

    def test_it_comes_each_second_with_the_counters_of_each_bus(self):
        for reader in self.each_reader():
            first = reader.sample("gateway_state")
            later = reader.sample("gateway_state", lambda data: data["uptime_s"] >= first["uptime_s"] + 2)
            between = [data for data in reader.samples("gateway_state") if first["uptime_s"] < data["uptime_s"] <= later["uptime_s"]]
            self.assertLess(len(between), 5)
            self.assertEqual((later["id"], later["axis_count"], later["axes_online"], later["state"]), (0, 2, 2, 1))
            self.assertEqual([bus["name"] for bus in later["buses"]], list(self.lines_of))
            for index, bus in enumerate(later["buses"]):
                now = self.client.bus(index)
                self.assertEqual(bus["link"], now["link"])
                self.assertTrue(0 <= bus["load"] <= 1, bus["load"])
                self.assertGreater(bus["requests"], first["buses"][index]["requests"])
                for name in [name for name, (_, kind) in BUS.items() if kind == "u32" and name != "echoes"]:  # no member of it
                    self.assertTrue(first["buses"][index][name] <= bus[name] <= now[name], name)

    def test_it_tells_of_a_bus_that_is_lost(self):
        self.sim.ask("unplug serial")
        for reader in self.each_reader():
            lost = reader.sample("gateway_state", lambda data: data["alarms"] & 0b10 and data["axes_online"] == 1)
            self.assertEqual([bus["link"] for bus in lost["buses"]], [0, 1])
            self.assertEqual(lost["state"], 2)


if __name__ == "__main__":
    main()
