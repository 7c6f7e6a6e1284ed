# SPDX-License-Identifier: Apache-2.0
"""The gateway before a slave that nobody here wrote: libmodbus's own server on the far pty of a socat cable."""
import os
import sys

from modbus import COMPLETED, DISABLED, OFFLINE, ONLINE, STANDSTILL
from processes import Program, until
from stage import Story, bus, drive, main

TURN = 10000
UNIT = 7
HERE = os.path.dirname(os.path.abspath(__file__))


class ForeignSlave(Story):
    def setUp(self):
        super().setUp()
        near, far = self.lay_cable()
        self.slave = self.keep(Program("slave", [sys.executable, "-B", f"{HERE}/libmodbus_slave.py", far, str(UNIT)]))
        self.slave.wait_for("^ready")
        self.configure(buses=[bus(near, drive("id286pro", UNIT, 1), adapter="modbus-rtu")])
        self.run_gateway()
        self.client = self.connect()
        self.until_online()
        self.stepper = self.axis(1)

    def lay_cable(self):
        near, far = self.path("near"), self.path("far")
        self.keep(Program("socat", ["socat", f"PTY,link={near},rawer", f"PTY,link={far},rawer"]))
        until("socat's ptys", lambda: os.path.islink(near) and os.path.islink(far))
        return near, far

    def test_it_comes_online_and_its_values_are_read(self):
        block = self.stepper.block()
        self.assertEqual((block["link_state"], block["axis_state"], block["dc_voltage"]), (ONLINE, DISABLED, 361))
        self.assertEqual(block["valid"] & block["supported"], block["supported"])
        counts = self.client.bus(0)
        self.assertEqual((counts["timeouts"], counts["bad_frames"], counts["late_replies"], counts["refused"]), (0, 0, 0, 0))

    def test_what_is_written_is_held(self):
        self.stepper.set(target_position=-3 * TURN, profile_acceleration=60000)
        self.assertEqual((self.stepper.get("target_position"), self.stepper.get("profile_acceleration")), (-3 * TURN, 60000))
        self.stepper.set(object_index=313, object_subindex=0, object_size=4)
        self.stepper.set(object_request=1)
        block = self.stepper.until(object_status=2)
        self.assertEqual(block["object_data"], -3 * TURN & 0xFFFFFFFF)
        # FC 16, both words in one request, the low one first.
        self.slave.wait_for(f"^{UNIT:02x}1001390002048ad0ffff")

    def test_a_move_that_is_over_before_anybody_looks_completes(self):
        self.stepper.command("enable")
        self.stepper.set(target_position=2 * TURN)
        number = self.stepper.command("move_absolute")
        self.stepper.until(motion_state=COMPLETED, motion_id=number, position_actual=2 * TURN)

    def test_an_exception_of_a_real_slave_is_understood(self):
        self.stepper.set(object_index=431, object_subindex=0, object_size=2)
        self.stepper.set(object_request=1)
        block = self.stepper.until(object_status=3)
        self.assertEqual((block["object_detail"], block["link_state"]), (2, ONLINE))

    def test_it_ends_and_comes_back(self):
        self.slave.process.kill()
        self.slave.ended()
        self.stepper.until(link_state=OFFLINE)
        self.slave = self.keep(Program("slave", self.slave.process.args))
        self.stepper.until(link_state=ONLINE)
        self.stepper.command("enable")
        self.stepper.until(axis_state=STANDSTILL)


if __name__ == "__main__":
    main()
