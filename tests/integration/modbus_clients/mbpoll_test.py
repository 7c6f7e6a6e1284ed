# SPDX-License-Identifier: Apache-2.0
"""mbpoll (libmodbus) reads and writes every table."""
import re
import subprocess
import sys
import unittest

from served import Served

PROGRAM = sys.argv.pop(1)


class Mbpoll(unittest.TestCase):
    options = ()
    unit = 1

    @classmethod
    def setUpClass(cls):
        cls.served = Served(PROGRAM, *cls.options)

    @classmethod
    def tearDownClass(cls):
        cls.served.stop()

    def mbpoll(self, table, address, *values, count=1, unit=None):
        command = ["mbpoll", "-m", "tcp", "-p", str(self.served.port), "-a", str(unit or self.unit), "-0", "-1", "-q", "-o", "2",
                   "-t", table, "-r", str(address)]
        if not values:
            command += ["-c", str(count)]
        command += ["-B", "127.0.0.1", *["--"][:bool(values)], *map(str, values)]
        return subprocess.run(command, capture_output=True, text=True, timeout=30)

    def read(self, table, address, count=1, **options):
        done = self.mbpoll(table, address, count=count, **options)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return [int(value) for value in re.findall(r"^\[\d+\]:\s+(-?\d+)", done.stdout, re.M)]

    def write(self, table, address, *values):
        done = self.mbpoll(table, address, *values)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def refusal(self, table, address, *values, **options):
        done = self.mbpoll(table, address, *values, **options)
        self.assertNotEqual(done.returncode, 0, done.stdout)
        return done.stdout + done.stderr


class FlatMap(Mbpoll):
    def test_reads_a_position_as_one_32_bit_value(self):
        self.assertEqual(self.read("4:int", 102), [100000])
        self.assertEqual(self.read("3:int", 102), [100000])

    def test_reads_the_word_order_test_value(self):
        self.assertEqual(self.read("4:int", 10), [0x01020304])

    def test_reads_coils_and_inputs(self):
        self.assertEqual(self.read("1", 100, count=3), [1, 0, 1])
        self.assertEqual(len(self.read("0", 100, count=10)), 10)

    def test_writes_one_register_and_reads_it_back(self):
        self.write("4", 146, 333)
        self.assertEqual(self.read("4", 146), [333])

    def test_writes_a_32_bit_value_whole(self):
        self.write("4:int", 142, -1234567)
        self.assertEqual(self.read("4:int", 142), [-1234567])

    def test_writes_one_coil_and_several(self):
        self.write("0", 100, 1)
        self.assertEqual(self.read("0", 100), [1])
        self.write("0", 100, 0, 0)
        self.assertEqual(self.read("0", 100), [0])

    def test_half_of_a_32_bit_value_is_an_illegal_address(self):
        self.assertIn("Illegal data address", self.refusal("4", 142, 1))

    def test_a_read_only_register_is_an_illegal_address(self):
        self.assertIn("Illegal data address", self.refusal("4", 102, 1))

    def test_an_axis_out_of_reach_still_reads_and_refuses_writes(self):
        self.assertEqual(self.read("4", 218), [4])
        self.assertIn("Gateway path unavailable", self.refusal("4", 246, 1))

    def test_a_refusal_of_the_drive_is_a_device_failure(self):
        self.assertIn("Slave device or server failure", self.refusal("4", 346, 1))

    def test_an_unknown_outcome_is_a_target_that_failed(self):
        self.assertIn("Target device failed to respond", self.refusal("4", 446, 1))


class LowWordFirst(Mbpoll):
    options = ("--low-first",)

    def test_reads_the_test_value_in_the_other_order(self):
        self.assertEqual(self.read("4:int", 10), [0x03040102])


class AxisPerUnit(Mbpoll):
    options = ("--per-axis",)

    def test_each_unit_shows_its_axis_and_255_all(self):
        self.assertEqual(self.read("4:int", 2, unit=1), [100000])
        self.assertEqual(self.read("4:int", 2, unit=3), [300000])
        self.assertEqual(self.read("4:int", 302, unit=255), [300000])

    def test_a_unit_without_an_axis_has_no_path(self):
        self.assertIn("Gateway path unavailable", self.refusal("4", 2, unit=9))


if __name__ == "__main__":
    unittest.main()
