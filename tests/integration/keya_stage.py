# SPDX-License-Identifier: Apache-2.0
"""Stories with a Keya KYDAS4860-2E: one drive, motors A and B as axes 1 and 2, on each of its four interfaces in turn. What the motors
really do is asked from the simulated drive; everything else is seen through Modbus-TCP."""
import signal
import time

from modbus import ALARM_ADOPTED, CONTINUOUS, DISABLED, ONLINE, STANDSTILL
from processes import until
from stage import Story, main  # noqa: F401 main: for the stories

ALARM_NO_COMM_WATCHDOG = 1
RPM = 1000
TURN = 10000
SPEED = 100  # rpm: 0.2 s of the drive's ramp as delivered
PATIENT = {"start_deadline_ms": 60000, "reply_deadline_ms": 60000}
CAN_LOSS, RS232_LOSS = 1 << 14, 1 << 15  # faults 15 and 16
LONGER_THAN_A_WATCHDOG_MS = 1500
LONGER_THAN_A_WATCHDOG = LONGER_THAN_A_WATCHDOG_MS / 1000
MANY_KEEP_ALIVES = 1.0  # seconds; they are 300 ms apart


class Interface:
    """What the simulator and a configuration call it, and the fault that the drive's watchdog leaves; 0 where it has none."""

    def __init__(self, name, simulated, adapter, loss, **settings):
        self.name, self.simulated, self.adapter, self.loss, self.settings = name, simulated, adapter, loss, settings

    @property
    def on_can(self):
        return self.simulated.startswith("lawicel:")


RS232 = Interface("rs232", "keya-rs232", "keya-rs232", RS232_LOSS, rs485="off")
RS485 = Interface("rs485", "keya-rs485@1", "keya-rs485", 0, rs485="off")
KEYA_CAN = Interface("its_own_can_protocol", "lawicel:keya-can@1", "keya-can", CAN_LOSS, bitrate=250000)
CANOPEN = Interface("canopen", "lawicel:keya-kydas4860-2e@1", "canopen", CAN_LOSS, bitrate=250000)


class on:  # pylint: disable=invalid-name
    """`@on(RS232, CANOPEN)` before `def test_x(self, interface)`: one test for each of these, test_x_on_rs232 and so on."""

    def __init__(self, *interfaces):
        self.interfaces = interfaces

    def __call__(self, tell):
        self.tell = tell
        return self

    def __set_name__(self, story, name):
        delattr(story, name)
        for interface in self.interfaces:
            setattr(story, f"{name}_on_{interface.name}", lambda test, interface=interface: self.tell(test, interface))


class KeyaStory(Story):
    drive = "cart/1"

    def begin(self, interface, *sim_options, drive="", lease=None, constants=None):
        """Everything is started, and both axes are online. `self.client` is the owner of what it commands; `self.watcher` only
        reads, so that it keeps no lease alive."""
        self.interface = interface
        self.simulate({"cart": interface.simulated + drive}, *sim_options)
        leases = lease if isinstance(lease, list) else [lease, lease]  # of A and B
        self.configure_cart([{"timeout_ms": 60000, **(each or {})} for each in leases], constants or {})
        self.run_gateway()
        self.connect_clients()

    def configure_cart(self, leases, constants):
        device = self.path("cart")
        axes = [{"axis": 1, "name": "left", "motor": "A", "lease": leases[0]},
                {"axis": 2, "name": "right", "motor": "B", "lease": leases[1]}]
        node = {} if self.interface is RS232 else {"node": 1}
        entry = {"name": "cart", "adapter": self.interface.adapter, "device": f"slcan:{device}" if self.interface.on_can else device,
                 "timeout_ms": 500, **self.interface.settings,
                 "drives": [{"profile": "keya-kydas4860-2e", **node, "constants": constants, "axes": axes}]}
        self.configure([self.listener(**PATIENT)], [entry])

    def connect_clients(self):
        self.client = self.connect()
        self.watcher = self.connect()
        until("both axes online", lambda: self.watcher.gateway()["axes_online"] == 2)
        self.axes = [self.client.axis(1), self.client.axis(2)]
        self.seen = [self.watcher.axis(1), self.watcher.axis(2)]

    # What the drive knows.

    def ask(self, word, *more):
        return self.sim.ask(" ".join([word, self.drive, *more]))

    def enabled(self):
        """Of motors A and B."""
        return [word == "1" for word in self.ask("enabled").split()]

    def speeds(self):
        return [int(word) for word in self.ask("speed").split()]

    def positions(self):
        return [int(word) for word in self.ask("position").split()]

    def faults(self):
        return [int(word, 16) for word in self.ask("faults").split()]

    def trips(self):
        return int(self.ask("trips"))

    def commands(self):
        return int(self.ask("commands"))

    def until_it_stands(self):
        until("both motors stand and are disabled", lambda: self.enabled() == [False, False] and self.speeds() == [0, 0])

    def assert_stopped_by_its_watchdog(self):
        until("the drive notices", lambda: self.trips() > 0)
        self.until_it_stands()
        for word in self.faults():
            self.assertTrue(word & self.interface.loss, f"fault word {word:#x}")

    def assert_runs_on(self):
        """No command for longer than any watchdog of this drive, and yet both motors turn."""
        until("silence", lambda: int(self.ask("last-command").split()[0]) > LONGER_THAN_A_WATCHDOG_MS)
        before = self.positions()
        until("both motors turn on", lambda: all(now > then for now, then in zip(self.positions(), before)))
        self.assertEqual((self.enabled(), self.trips()), ([True, True], 0))

    # What an owner does.

    def enable(self, axis):
        axis.command("enable")
        axis.until(axis_state=STANDSTILL)

    def run_axis(self, axis, rpm=SPEED):
        axis.set(target_velocity=rpm * RPM)
        number = axis.command("run_velocity")
        axis.until(axis_state=CONTINUOUS)
        until(f"it runs at {rpm} rpm", lambda: abs(axis.get("velocity_actual") - rpm * RPM) <= 5 * RPM)
        return number

    def run_both(self):
        for axis in self.axes:
            self.enable(axis)
        return [self.run_axis(axis) for axis in self.axes]

    def let_pass(self, seconds, while_true=lambda: True):
        """In which the gateway answers."""
        over = time.monotonic() + seconds
        until("time", lambda: not while_true() or (self.watcher.gateway() and time.monotonic() > over))

    def assert_never_enabled(self, where):
        """While many a keep-alive would be due. Looks without a pause: an enable for a moment is one too."""
        over = time.monotonic() + MANY_KEEP_ALIVES
        while self.watcher.gateway() and time.monotonic() <= over:
            self.assertEqual((self.enabled(), self.positions()), ([False, False], where), f"faults {self.ask('faults')}")

    def assert_nothing_is_enabled_by_itself(self, where=None):
        """Time in which both axes stay online and disabled and no motor turns, also not since it stood at `where`."""
        where = where or self.positions()
        for axis in self.seen:
            axis.until(link_state=ONLINE)
        self.assert_never_enabled(where)
        for axis in self.seen:
            block = axis.until(link_state=ONLINE)
            self.assertNotIn("enabled", axis.inputs())
            self.assertFalse(block["axis_alarms"] & ALARM_ADOPTED)

    def assert_fresh_enable_works(self):
        for number in self.run_both():
            self.assertGreater(number, 0)
        for axis in self.axes:
            self.assertEqual(axis.get("error_code"), 0)
        trips = self.trips()
        self.let_pass(LONGER_THAN_A_WATCHDOG, self.client.gateway)  # an owner lives by what it asks
        self.assertEqual((self.enabled(), self.trips()), ([True, True], trips), "it is kept alive")
        for axis in self.axes:
            axis.command("disable")
            axis.until(axis_state=DISABLED)
        self.until_it_stands()

    def kill_the_gateway(self):
        self.gateway.send(signal.SIGKILL)
        self.assertEqual(self.gateway.ended(), -signal.SIGKILL)

    def start_another_gateway(self):
        self.run_gateway()
        self.connect_clients()
