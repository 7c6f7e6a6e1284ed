# SPDX-License-Identifier: Apache-2.0
"""axisgate-dds dies or stands still: the gateway and its drives go on, and the topics come back."""
import os
import signal
import threading
from contextlib import suppress

from dds_stage import ALARM_DDS_DOWN, FAST, RPM, VENDORS, DdsStory, main
from lease_stage import ME
from modbus import Axis
from processes import until


RPM_UNITS = 1000  # of a register


class Background:
    """Does something again and again in a thread until it is left. What goes wrong there is raised at its end."""

    def __init__(self, work):
        self.work = work
        self.turns = 0
        self.over = threading.Event()
        self.failed = None
        self.thread = threading.Thread(target=self.run)

    def run(self):
        try:
            while not self.over.is_set():
                self.work()
                self.turns += 1
        except BaseException as failed:  # pylint: disable=broad-except
            self.failed = failed

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.over.set()
        self.thread.join()
        if self.failed:
            raise self.failed

    def more(self, count=20):
        """It has come round so often since now."""
        wanted = self.turns + count
        until("it goes on", lambda: self.turns >= wanted or self.failed)


class Signalled(DdsStory):
    def signal(self, pid, number):
        """To the gateway or its process; none of them is left standing."""
        def go_on():
            with suppress(ProcessLookupError):
                os.kill(pid, signal.SIGCONT)

        self.addCleanup(go_on)
        os.kill(pid, number)


class Disturbed(Signalled):
    """A Modbus client has axis 1 turning and asks without pause, a DDS client axis 2."""

    lines_of = ("serial", "modbus")
    lease = {"timeout_ms": 4000}

    def setUp(self):
        super().setUp()
        self.begin()
        self.alarms = set()
        self.turning = [1]
        self.simulator_is_asked = threading.Lock()

    def speed(self, number):
        with self.simulator_is_asked:
            return super().speed(number)

    def work(self):
        """Of the Modbus client: any request that fails is raised, and so is a motor that stands."""
        self.alarms.add(self.plc.gateway()["alarms"] & ALARM_DDS_DOWN)
        block = self.axis_1.block()
        self.rpm = 300 if self.rpm != 300 else 200
        self.axis_1.set(target_velocity=self.rpm * RPM_UNITS)
        self.assertEqual(block["owner"], ME)
        self.assertNotEqual(block["velocity_actual"], 0)
        for number in self.turning:
            self.assertNotEqual(self.speed(number), 0, f"motor {number} stands")

    def run_both(self, vendor):
        self.plc, self.rpm = self.peer(), 300
        self.axis_1 = Axis(self.plc, 1)
        self.set_running(self.axis_1)
        self.until_it_turns_at(1, 300)
        peer = self.commander(vendor)
        for topic in ("axis_state", "gateway_state"):
            peer.read(topic)
        self.run_by_dds(peer, 2)
        return peer

    def disturb(self, number):
        """A signal to axisgate-dds."""
        self.before = self.dds_process()
        self.signal(self.before, number)

    def until_all_is_back(self, peer, place, asking):
        until("the alarm is seen", lambda: ALARM_DDS_DOWN in self.alarms or asking.failed)
        until("another process is there", lambda: self.dds_process() not in (None, self.before) or asking.failed)
        for topic in ("axis_state", "gateway_state"):
            peer.wait("matched", topic, lambda told: told["count"] > 0, place)
        since = peer.now()
        for number in self.numbers:
            peer.sample("axis_state", since=since, axis=number)
        peer.sample("gateway_state", lambda data: not data["alarms"] & ALARM_DDS_DOWN, since=since)
        until("the alarm is gone", lambda: not self.watcher.gateway()["alarms"] & ALARM_DDS_DOWN)
        peer.knock("axis_command", "command_reply")

    def end(self, peer):
        self.let_go(peer, 2)
        self.axis_1.command("disable")
        self.axis_1.command("release")
        peer.leave()


class Killed(Disturbed):
    def test_a_fast_client_and_a_modbus_client_keep_their_motors_turning(self):
        peer = self.run_both(FAST)
        self.turning = [1, 2]  # the DDS client lives: its lease has a grace
        with Background(self.work) as asking:
            asking.more()
            place = peer.now()
            self.disturb(signal.SIGKILL)
            self.until_all_is_back(peer, place, asking)
            peer.do(2, "none", target_velocity=200 * RPM)
            self.until_it_turns_at(2, 200)
            asking.more()
        self.gateway.wait_for("axisgate-dds was killed: signal 9")
        self.end(peer)


class Stands(Disturbed):
    def test_it_stands_still_and_is_replaced(self):
        peer = self.run_both(FAST)
        with Background(self.work) as asking:
            asking.more()
            place = peer.now()
            self.disturb(signal.SIGSTOP)
            self.until_it_stands(2)  # whether its master lives cannot be told
            self.until_all_is_back(peer, place, asking)
            asking.more()
        self.gateway.wait_for("took nothing from the gateway for too long and was killed")
        peer.do(2, "enable")
        peer.do(2, "run_velocity", target_velocity=200 * RPM)
        self.until_it_turns_at(2, 200)
        self.end(peer)


# As deploy's users write it: a profile replaces the whole QoS of its topic.
QOS = """<?xml version="1.0"?>
<profiles xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles">
  <data_writer profile_name="axisgate_axis_state">
    <topic>
      <historyQos><kind>KEEP_LAST</kind><depth>1</depth></historyQos>
      <resourceLimitsQos>
        <max_samples>500</max_samples><max_instances>500</max_instances><max_samples_per_instance>1</max_samples_per_instance>
      </resourceLimitsQos>
    </topic>
    <qos>
      <reliability><kind>RELIABLE</kind></reliability>
      <durability><kind>TRANSIENT_LOCAL</kind></durability>
      <deadline><period><sec>1</sec></period></deadline>
      <liveliness>
        <kind>AUTOMATIC</kind>
        <lease_duration><sec>1</sec></lease_duration><announcement_period><nanosec>300000000</nanosec></announcement_period>
      </liveliness>
    </qos>
  </data_writer>
</profiles>
"""


class Missed(Signalled):
    """Subscribers that ask for a deadline and for liveliness, and a configuration that offers both."""

    lines_of = ("serial",)
    dds = {"max_period_ms": 300, "qos_file": "qos.xml"}

    def setUp(self):
        super().setUp()
        with open(self.path("qos.xml"), "w", encoding="utf-8") as file:
            file.write(QOS)
        self.begin()
        self.readers = [self.peer_of(vendor).read("axis_state", "deadline", 1500, "automatic", 1500) for vendor in VENDORS]
        for reader in self.readers:
            self.at = reader.name
            reader.sample("axis_state", axis=1)
            self.assertEqual(reader.all("deadline_missed", "axis_state"), [])

    def test_a_gateway_that_stands_still_misses_the_deadline(self):
        self.signal(self.gateway.pid, signal.SIGSTOP)
        for reader in self.readers:
            self.at = reader.name
            reader.wait("deadline_missed", "axis_state")
        os.kill(self.gateway.pid, signal.SIGCONT)
        for reader in self.readers:
            reader.sample("axis_state", since=reader.now(), axis=1)

    def test_of_a_dds_process_that_stands_still_the_liveliness_is_lost(self):
        self.signal(self.dds_process(), signal.SIGSTOP)
        for reader in self.readers:
            self.at = reader.name
            reader.wait("liveliness", "axis_state", lambda told: told["alive"] == 0)


if __name__ == "__main__":
    main()
