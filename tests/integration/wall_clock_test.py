# SPDX-License-Identifier: Apache-2.0
"""The wall clock jumps while motors run: nothing is lost, ended or started by that, and a lease takes as long as it would have."""
import datetime
import os
import struct
import subprocess

from lease_stage import ME, NOBODY, PLC, RPM, Axis, Machine, main
from modbus import CONTINUOUS, ONLINE
from processes import NEVER, until
from stage import AXISGATE, SOURCE, Gateway

HOUR = 3600
JUMPS = (2 * HOUR, -2 * HOUR, -40 * 365 * 24 * HOUR, 0)  # a battery that is empty: before 1990


class WithAClockOfItsOwn(Machine):
    lines_of = ("serial", "stepper", "leadshine")

    def setUp(self):
        super().setUp()
        shim = self.path("wall_clock.so")
        subprocess.run(["cc", "-shared", "-fPIC", "-o", shim, f"{SOURCE}/tests/integration/wall_clock.c"], check=True, timeout=NEVER)
        self.clock = self.path("wall_clock")
        self.jump(0)
        self.environment = ["TZ=UTC", f"LD_PRELOAD={shim}", f"AXISGATE_WALL_CLOCK={self.clock}"]

    def run_gateway(self, *options):
        self.gateway = self.keep(Preloaded(self.environment, self.config, *options)).wait_until_it_listens()
        return self.gateway

    def jump(self, seconds):
        """In place: the gateway has the file mapped."""
        file = os.open(self.clock, os.O_WRONLY | os.O_CREAT)
        os.pwrite(file, struct.pack("=q", seconds), 0)
        os.close(file)


class LongLease(WithAClockOfItsOwn):
    lease = {"timeout_ms": 60000}

    def hours_told(self, since):
        """How far the time of each line of the log is from the machine's."""
        for line in list(self.gateway.lines)[since:]:
            if line[:2].isdigit():
                yield (datetime.datetime.fromisoformat(line[:19]) - datetime.datetime.utcnow()).total_seconds() / HOUR

    def test_motors_run_on_and_obey(self):
        self.begin()
        owner = self.peer(PLC)
        axes = {number: Axis(owner, number) for number in self.numbers}
        for axis in axes.values():
            self.set_running(axis)
        for turn, seconds in enumerate(JUMPS):
            lines = len(self.gateway.lines)
            self.jump(seconds)
            for number, axis in axes.items():
                speed = 300 * RPM * (-1 if turn % 2 == 0 else 1)
                axis.set(target_velocity=speed)
                until("it turns the other way", lambda axis=axis, speed=speed: abs(axis.get("velocity_actual") - speed) < abs(speed) / 5)
                block = axis.block()
                self.assertEqual((block["link_state"], block["axis_state"], block["owner"]), (ONLINE, CONTINUOUS, ME))
                axis.command("halt")
                self.until_it_stands(number)
                axis.set(target_velocity=speed)
                axis.command("run_velocity")
                self.until_it_turns(number)
            until("the clock has jumped", lambda lines=lines, seconds=seconds: any(
                abs(hours - seconds / HOUR) < 0.5 for hours in self.hours_told(lines)))
        self.assertFalse([line for line in self.gateway.lines if "lease" in line and "ran out" in line], "no lease has ended")


class ShortLease(WithAClockOfItsOwn):
    lease = {"timeout_ms": 3000}

    def test_it_runs_out_though_the_clock_went_back(self):
        self.begin()
        owner = self.peer(PLC)
        for number in self.each():
            self.set_running(Axis(owner, number))
        self.jump(-2 * HOUR)
        owner.fall_silent()
        for number in self.each():
            self.assert_stopped_for_good(number)
            self.assertEqual(self.watched(number).get("owner"), NOBODY)


class Preloaded(Gateway):
    def __init__(self, environment, config, *options):
        super(Gateway, self).__init__("axisgate run", ["env", *environment, AXISGATE, "run", config, *options])


if __name__ == "__main__":
    main()
