# SPDX-License-Identifier: Apache-2.0
"""axis_state and axis_event: what subscribers of both vendors read is what the registers show, and who comes late hears the newest. The
rest of it is told by tests/unit/dds and, with a Fast DDS peer, by tests/dds_process."""
import math
from fractions import Fraction

from dds_stage import FAULT, RPM, VENDORS, DdsStory, main
from modbus import AXIS, ERROR_STOP, Axis
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


class Late(Watched):
    dds = {"max_period_ms": 600000}
    topic = "axis_event"

    def test_a_fault_is_told_with_its_code_and_who_comes_late_hears_of_it_and_of_the_last_state_of_every_axis(self):
        self.sim.ask("fault serial/1 2601 0x0100")
        code = 0x7110
        self.watched(1).until(axis_state=ERROR_STOP, error_code=code)
        for reader in self.each_reader():
            self.assertTrue(reader.sample("axis_event", axis=1, kind=FAULT, code=code)["text"])
        for vendor in self.each_vendor():
            late = self.peer_of(vendor).read("axis_event").read("axis_state")
            late.sample("axis_event", axis=1, kind=FAULT, code=code)
            for number in self.numbers:
                self.assertEqual(late.sample("axis_state", axis=number)["name"], self.motors[number][0])
                self.assert_same(*self.newest(late, number))


if __name__ == "__main__":
    main()
