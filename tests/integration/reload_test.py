# SPDX-License-Identifier: Apache-2.0
"""A configuration is changed while motors turn: what goes on, what is restarted, and what is refused."""
import json
import os
import re
import shutil
import signal
import subprocess

from modbus import Client, Closed, ONLINE
from processes import NEVER, Program, until
from stage import AXISGATE, SOURCE, Story, bus, drive, main

DISABLED, CONTINUOUS = 0, 3
CHANGED_ON_DISK = 1 << 8  # gateway alarms


class ReloadStory(Story):
    """A lift and a feeder, each on its bus."""

    def buses(self, lift=None, feeder=None):
        return [bus(self.path("lift"), drive("jd", 1, 1, **(lift or {}))),
                bus(self.path("feeder"), drive("md", 1, 2, **(feeder or {})))]

    def reload(self):
        return self.command_line("reload", self.config)

    def rewrite(self, listeners=None, buses=None):
        """The listeners stay, unless others are given."""
        with open(self.config, encoding="utf-8") as file:
            before = json.load(file)
        config = {"modbus_tcp": listeners or before["modbus_tcp"], "buses": buses or before["buses"]}
        with open(self.config, "w", encoding="utf-8") as file:
            json.dump(config, file)
        return config

    def turn(self, axis):
        axis.command("enable")
        axis.set(target_velocity=60_000)
        axis.command("run_velocity")
        axis.until(axis_state=CONTINUOUS)

    def refused(self, *parts):
        done = self.reload()
        self.assertEqual(done.returncode, 1, done.stdout)
        for part in parts:
            self.assertIn(part, done.stderr)

    def taken(self, *lines):
        done = self.reload()
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        # What was changed by its keys is told behind it.
        self.assertEqual([line for line in done.stdout.splitlines() if " -> " not in line], list(lines))
        return done.stdout

    def rewrite_whole(self, config):
        with open(self.config, "w", encoding="utf-8") as file:
            json.dump(config, file)


class Reload(ReloadStory):
    def test_a_changed_bus_is_restarted_beside_a_motor_that_turns(self):
        self.start()
        lift, feeder = self.axis(1), self.axis(2)
        self.turn(lift)
        requests = self.client.bus(0)["timeouts"], self.client.bus(0)["reconnects"]
        self.rewrite(buses=self.buses(feeder={"name": "conveyor", "units_per_rev": 3600}))
        told = self.taken("bus feeder: changed")
        for key in ('drives/0/axes/0/name "md-2" -> "conveyor"', "drives/0/axes/0/units_per_rev (not given) -> 3600"):
            self.assertIn(f"bus feeder: {key}\n", told)
            self.assertTrue(self.gateway.found(re.escape(f"bus feeder: {key}")), "in the log as well")
        self.assertEqual(lift.get("axis_state"), CONTINUOUS)
        self.until_online()
        self.assertEqual((self.client.bus(0)["timeouts"], self.client.bus(0)["reconnects"]), requests)
        self.turn(feeder)  # by the same connection
        self.assertEqual(lift.get("axis_state"), CONTINUOUS)
        self.taken("nothing has changed")

    def test_an_enabled_axis_of_the_bus_refuses_all_of_it(self):
        self.start()
        lift = self.axis(1)
        self.turn(lift)
        until("no alarm", lambda: not self.client.gateway()["alarms"] & CHANGED_ON_DISK)
        self.rewrite(buses=self.buses(lift={"name": "hoist"}, feeder={"name": "conveyor"}))
        self.refused("axis 1 (jd-1) has torque")
        self.gateway.wait_for("reload refused, and nothing was changed: axis 1 ")
        self.assertEqual(lift.get("axis_state"), CONTINUOUS)
        self.assertEqual(self.axis(2).get("link_state"), ONLINE)
        until("the alarm", lambda: self.client.gateway()["alarms"] & CHANGED_ON_DISK)
        lift.command("disable")
        lift.until(axis_state=DISABLED)
        self.taken("bus lift: changed", "bus feeder: changed")
        until("no alarm", lambda: not self.client.gateway()["alarms"] & CHANGED_ON_DISK)
        self.until_online()

    def test_a_file_with_mistakes_changes_nothing(self):
        self.start()
        self.turn(self.axis(1))
        with open(self.config, "w", encoding="utf-8") as file:
            file.write("{\n  \"modbus_tcp\": [,\n")
        self.refused("gateway.json:2:")
        self.assertEqual(self.axis(1).get("axis_state"), CONTINUOUS)
        self.rewrite_whole({"modbus_tcp": [{"listen": "127.0.0.1:1"}], "buses": self.buses(), "dds": {"interfaces": ["lo"]}})
        self.refused("/dds: ")
        self.assertEqual(self.axis(1).get("axis_state"), CONTINUOUS)

    def test_what_a_profile_extends_counts_as_the_profile(self):
        for name in ("cia402", "kinco", "kinco-jd"):
            shutil.copy(f"{SOURCE}/schemas/drives/{name}.json", self.folder)
        with open(self.path("mine.json"), "w", encoding="utf-8") as file:
            json.dump({"profile": 1, "name": "mine", "extends": "kinco-jd"}, file)
        buses = self.buses()
        buses[0]["drives"][0]["profile"] = self.path("mine.json")
        self.start(buses=buses)
        until("no alarm", lambda: not self.client.gateway()["alarms"] & CHANGED_ON_DISK)
        with open(self.path("kinco.json"), encoding="utf-8") as file:
            base = json.load(file)
        base["protocols"]["kinco-serial"]["worst_reply_ms"] = 600
        with open(self.path("kinco.json"), "w", encoding="utf-8") as file:
            json.dump(base, file)
        until("the alarm", lambda: self.client.gateway()["alarms"] & CHANGED_ON_DISK)
        self.taken("bus lift: changed")
        until("no alarm", lambda: not self.client.gateway()["alarms"] & CHANGED_ON_DISK)
        base["protocols"]["kinco-serial"]["worst_reply_ms"] = "long"
        with open(self.path("kinco.json"), "w", encoding="utf-8") as file:
            json.dump(base, file)
        self.refused(f"{self.path('kinco.json')}:1:", ": /protocols/kinco-serial/worst_reply_ms: must be integer, is string")

    def test_a_service_reloads_on_sighup(self):
        self.simulate()
        self.configure()
        self.gateway = self.keep(Program("axisgate", ["env", "--default-signal=HUP", AXISGATE, "run", self.config], start_new_session=True))
        self.gateway.wait_for("listening on ")
        self.client = self.connect()
        self.until_online()
        self.rewrite(buses=self.buses(feeder={"name": "conveyor"}))
        self.gateway.send(signal.SIGHUP)
        self.gateway.wait_for("was read anew: bus feeder: changed")
        self.until_online()

    def test_buses_and_axes_come_and_go(self):
        self.simulate({"lift": "jd@1", "feeder": "md@1", "third": "md@1"})
        self.configure()
        self.run_gateway()
        self.client = self.connect()
        self.until_online()
        lift = self.axis(1)
        self.turn(lift)
        self.rewrite(buses=[bus(self.path("third"), drive("md", 1, 7)), *self.buses()])
        self.taken("bus third: added")
        until("three axes", lambda: self.client.gateway()["axis_count"] == 3)
        self.until_online()
        self.turn(self.axis(7))
        self.axis(7).command("disable")
        self.axis(7).until(axis_state=DISABLED)
        self.rewrite(buses=self.buses())
        self.taken("bus third: removed")
        self.assertEqual(self.client.gateway()["axis_count"], 2)
        with self.assertRaises(Exception):
            self.axis(7).get("axis_state")
        self.assertEqual(lift.get("axis_state"), CONTINUOUS)

    def test_nobody_but_the_gateway_s_user_and_root_is_heard(self):
        if os.getuid() != 0:
            return  # there is only one user to ask as
        self.start()
        ask = """
import socket, sys
asker = socket.socket(socket.AF_UNIX)
asker.connect(chr(0) + "axisgate/" + sys.argv[1])
try:
    asker.sendall(b"reload" + bytes([10]))
    print(asker.recv(4))
except OSError:
    print("closed")
"""
        for user, answers in ((65534, ("b''", "closed")), (0, ("b'done'",)), (65534, ("b''", "closed"))):
            done = subprocess.run(["/usr/bin/python3", "-c", ask, self.config], user=user, group=user, extra_groups=[], cwd="/",
                                  capture_output=True, text=True, timeout=NEVER, check=True)
            self.assertIn(done.stdout.strip(), answers)
        self.assertEqual(len(self.gateway.found("read anew")), 1)

    def test_without_a_gateway_that_is_said(self):
        self.configure()
        self.refused("no gateway runs here with " + self.config)

    def test_a_hundred_reloads_leave_nothing_behind(self):
        self.start()
        self.turn(self.axis(1))
        open_files = f"/proc/{self.gateway.pid}/fd"
        names = ("conveyor", "belt")
        for i in range(100):
            self.rewrite(buses=self.buses(feeder={"name": names[i % 2]}))
            until("the feeder may be taken", lambda: self.reload().returncode == 0)
            if i == 0:
                self.until_online()
                used = len(os.listdir(open_files))
        self.until_online()
        until("no more open files than after the first", lambda: len(os.listdir(open_files)) <= used)
        self.assertEqual(self.axis(1).get("axis_state"), CONTINUOUS)


class TwoListeners(ReloadStory):
    def setUp(self):
        super().setUp()
        self.start(listeners=[self.listener(), self.listener()])
        self.other = self.connect(1)

    def listeners(self):
        with open(self.config, encoding="utf-8") as file:
            return json.load(file)["modbus_tcp"]


class Listeners(TwoListeners):
    def test_one_that_is_as_before_keeps_its_connections(self):
        self.turn(self.axis(1))
        first, second = self.listeners()
        self.rewrite(listeners=[{**second, "word_order": "low-first"}, first])
        self.taken(f"listener {second['listen']}: changed")
        self.assertEqual(self.axis(1).get("axis_state"), CONTINUOUS)
        with self.assertRaises(Closed):
            self.other.gateway()
        again = Client(self.ports[1])
        self.addCleanup(again.close)
        self.assertEqual(again.gateway()["axis_count"], 2)

    def test_one_is_added_and_one_removed(self):
        first, second = self.listeners()
        third = self.listener()
        self.rewrite(listeners=[first, third])
        self.taken(f"listener {third['listen']}: added", f"listener {second['listen']}: removed")
        with self.assertRaises(Closed):
            self.other.gateway()
        with self.assertRaises(Closed):
            Client(self.ports[1])
        added = Client(int(third["listen"].rpartition(":")[2]))
        self.addCleanup(added.close)
        self.assertEqual(added.gateway()["axis_count"], 2)


class OwnedThroughAListener(TwoListeners):
    """With leases: a connection that is closed would stop the motor of its client."""

    def buses(self, lift=None, feeder=None):
        owned = {"timeout_ms": 60000}
        return super().buses({"lease": owned, **(lift or {})}, {"lease": owned, **(feeder or {})})

    def test_its_client_s_turning_motor_refuses_it(self):
        mine = self.other.axis(1)
        self.turn(mine)
        first, second = self.listeners()
        self.rewrite(listeners=[first, {**second, "word_order": "low-first"}])
        self.refused("would close the connection of 127.0.0.1:", "owns axis 1")
        self.assertEqual(mine.get("axis_state"), CONTINUOUS)
        mine.command("disable")
        mine.until(axis_state=DISABLED)
        self.taken(f"listener {second['listen']}: changed")


if __name__ == "__main__":
    main()
