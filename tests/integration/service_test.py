# SPDX-License-Identifier: Apache-2.0
"""The gateway as a service: what a service manager hears of it (sd_notify(3))."""
import os
import re
import signal
import socket
import subprocess

from modbus import ONLINE
from processes import NEVER, Program, until
from stage import AXISGATE, Story, main

WATCHDOG_S = 1


class Service(Story):
    def setUp(self):
        super().setUp()
        self.simulate()
        self.configure()
        self.manager = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.addCleanup(self.manager.close)
        self.manager.settimeout(NEVER)
        self.manager.bind(self.path("notify"))
        self.environment = {**os.environ, "NOTIFY_SOCKET": self.path("notify"), "WATCHDOG_USEC": str(WATCHDOG_S * 1_000_000)}
        self.environment.pop("WATCHDOG_PID", None)

    def run_as_a_service(self):
        self.gateway = self.keep(Program("axisgate", ["env", "--default-signal=HUP", AXISGATE, "run", self.config],
                                         start_new_session=True, env=self.environment))
        self.gateway.wait_for("listening on ")
        self.client = self.connect()

    def hears(self, wanted):
        """The next message that is not about the watchdog, unless that is wanted."""
        while True:
            message = self.manager.recv(4096).decode()
            if message != "WATCHDOG=1" or wanted == message:
                self.assertRegex(message, wanted)
                return message

    def hears_signs_of_life(self, count=4):
        for _ in range(count):
            self.hears("WATCHDOG=1")

    def test_ready_reloading_and_stopping(self):
        self.run_as_a_service()
        self.hears("^READY=1\nSTATUS=2 axes on 2 buses$")
        self.hears_signs_of_life()
        self.gateway.send(signal.SIGHUP)
        reloading = self.hears("^RELOADING=1\nMONOTONIC_USEC=[0-9]+\nSTATUS=")
        self.assertGreater(int(re.search("USEC=([0-9]+)", reloading).group(1)), 0)
        self.hears("^READY=1\n")
        self.gateway.send(signal.SIGTERM)
        self.hears("^STOPPING=1\n")
        self.assertEqual(self.gateway.ended(), 0)

    # None of the two is a reason to end what moves other motors.
    def test_an_unresponsive_drive_and_a_missing_device_are_no_hang(self):
        self.run_as_a_service()
        self.hears("^READY=1\n")
        self.until_online()
        self.sim.ask("unresponsive lift/1 on")
        self.client.axis(1).until(link_state=4)
        os.unlink(self.path("feeder"))
        self.hears_signs_of_life(3 * WATCHDOG_S * 4)

    def test_a_log_that_nobody_reads_is_no_hang(self):
        unread, log = os.pipe()
        self.addCleanup(os.close, unread)
        with subprocess.Popen([AXISGATE, "run", self.config, "--decode", "lift"], start_new_session=True, env=self.environment,
                              stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=log) as gateway:
            os.close(log)
            try:
                self.hears("^READY=1\n")
                self.client = self.connect()
                self.until_online()
                self.hears_signs_of_life(2 * WATCHDOG_S * 4)
                self.assertEqual(self.client.axis(1).get("link_state"), ONLINE)
                gateway.terminate()
                self.assertEqual(gateway.wait(NEVER), 0)
            finally:
                gateway.kill()

    # systemd itself hangs: motors are still commanded, and stopped at the end.
    def test_a_manager_that_hears_nothing_holds_up_nothing(self):
        self.environment["WATCHDOG_USEC"] = "4000"
        self.run_as_a_service()
        self.until_online()
        until("a second of signs of life untold", lambda: self.client.gateway()["uptime_s"] >= 2)
        self.client.axis(1).command("enable")
        self.gateway.send(signal.SIGTERM)
        self.assertEqual(self.gateway.ended(), 0)


if __name__ == "__main__":
    main()
