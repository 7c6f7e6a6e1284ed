# SPDX-License-Identifier: Apache-2.0
"""Gateways without the compose set: with a device that is granted by name, without one, without topics, and many that find each other
by a discovery server. Run by tests/containers/run."""
import json
import os
import shlex
import tempfile
import unittest

from engine import LIMITS, Container
from container_stage import ENGINE, SIMULATOR, SOURCE, USER, patient, plain_json
from page_commands import of_page
from processes import NEVER, Program, until

SEALED = ["--read-only", "--read-only-tmpfs=false", "--cap-drop=all", "--security-opt=no-new-privileges"]


class OneGateway(unittest.TestCase):
    """A gateway alone, with one drive outside that is granted to it by its name."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-one-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        os.chmod(self.folder, 0o755)
        self.simulator = Program("axisgate-sim", [SIMULATOR, "--line", f"{self.folder}/lift:jd@1", "--control", f"{self.folder}/control"])
        self.addCleanup(self.simulator.clean_up)
        self.simulator.wait_for("^control ")
        self.device = os.path.realpath(f"{self.folder}/lift")

    def configuration(self):
        config = patient(plain_json(f"{SOURCE}/deploy/container/compose.json"))
        config["modbus_tcp"] = [{"listen": "127.0.0.1:1502"}]
        del config["dds"], config["buses"][1]
        config["buses"][0]["device"] = "/dev/lift"
        return config

    def gateway(self, image, *options, **more):
        self.write({**self.configuration(), **more})
        container = Container(ENGINE, "one")
        self.addCleanup(container.remove)
        container.create([*SEALED, "--network", "none", "--volume", f"{self.folder}/gateway.json:/etc/axisgate/gateway.json:ro", *options], image, [])
        container.start()
        return container

    def write(self, config):
        self.config = config
        with open(f"{self.folder}/gateway.json", "w", encoding="utf-8") as file:
            json.dump(config, file)

    def top(self, container):
        return ENGINE.done("exec", container.name, "/usr/bin/axisgate", "top", "127.0.0.1:1502", "--once").stdout

    def granted(self):
        """To the user of the image, as a rule of udev or a group does it."""
        os.chown(self.device, USER, -1)
        return ["--volume", f"{self.device}:/dev/lift:dev"]

    def test_a_granted_device_is_used(self):
        container = self.gateway("localhost/axisgate", *self.granted())
        until("its axis is online", lambda: "axes online 1 of 1" in self.top(container))

    def test_a_changed_configuration_is_taken_up_from_inside(self):
        container = self.gateway("localhost/axisgate", *self.granted())
        until("its axis is online", lambda: "axes online 1 of 1" in self.top(container))
        self.config["buses"][0]["drives"][0]["axes"][0]["axis"] = 7
        self.write(self.config)
        reload = ("exec", container.name, "/usr/bin/axisgate", "reload", "/etc/axisgate/gateway.json")
        until("it is taken up", lambda: ": changed" in ENGINE.done(*reload).stdout)
        until("as axis 7", lambda: "   7  online" in self.top(container))

    def typed(self, command, **mine):
        """A command of docs/containers.md as it stands there, but for what is the reader's own. What it prints."""
        for named, is_here in {"./gateway.json": f"{self.folder}/gateway.json", **mine}.items():
            command = command.replace(named, is_here)
        engine, verb, *words = shlex.split(command)
        self.assertEqual(engine, "podman")
        return ENGINE(verb, *(["--pull=never", *LIMITS] if verb == "run" else []), *words)

    def test_the_pages_commands_run_one(self):
        self.addCleanup(Container(ENGINE, "gateway").remove)
        self.write({**self.configuration(), "modbus_tcp": [{"listen": "0.0.0.0:1502", "allow": [{"from": "127.0.0.1", "role": "operator"}]}]})
        self.assertIn("is valid", self.typed(of_page("docs/containers.md", "podman run --rm")))
        # A pseudo-terminal is no device that can be made anew in a container: it is granted as a file. The rest of the line stays, the group too.
        os.chown(self.device, 0, 20)
        os.chmod(self.device, 0o660)
        command = of_page("docs/containers.md", "podman run -d")
        granted = "--device /dev/serial/by-id/usb-FTDI_...:/dev/lift"
        self.assertIn(granted, command)
        # Not every root may raise a limit: see LIMITS.
        self.typed(command.replace(granted, f"--volume {self.device}:/dev/lift:dev").replace("nofile=4096", "nofile=1024:1024"))
        look = of_page("docs/containers.md", "podman exec gateway")
        until("its axis is online", lambda: "axes online 1 of 1" in self.typed(look))
        self.config["buses"][0]["drives"][0]["axes"][0]["axis"] = 7
        self.write(self.config)
        self.assertIn(": changed", self.typed(of_page("docs/containers.md", "podman exec NAME"), NAME="gateway"))
        until("as axis 7", lambda: "   7  online" in self.typed(look))

    def test_a_device_that_was_not_granted_is_not_there_and_all_else_works(self):
        container = self.gateway("localhost/axisgate")
        container.says("/dev/lift")
        until("healthy", container.healthy)
        self.assertIn("axes online 0 of 1", self.top(container))

    def test_without_dds_programs_the_gateway_says_so_and_goes_on(self):
        container = self.gateway("localhost/axisgate", *self.granted(), dds={})
        container.says("axisgate-dds")
        until("its axis is online", lambda: "axes online 1 of 1" in self.top(container))

    def test_a_wrong_configuration_ends_it_with_file_and_place(self):
        container = self.gateway("localhost/axisgate", buses=[])
        self.assertEqual(ENGINE("wait", container.name), "1")
        self.assertRegex(container.text(), r"/etc/axisgate/gateway\.json:\d+:\d+: /buses")


class ManyGateways(unittest.TestCase):
    """Their participants are told of no other address than the discovery server's; multicast is not used then."""

    SERVER = "172.30.98.2"

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-many-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        os.chmod(self.folder, 0o755)
        self.addCleanup(ENGINE.done, "network", "rm", "--force", "cells")
        ENGINE("network", "create", "--subnet", "172.30.98.0/24", "cells")

    def start(self, name, image, command, *options):
        container = Container(ENGINE, name)
        self.addCleanup(container.remove)
        container.create([*SEALED, "--network", "cells", "--no-healthcheck", *options], image, command)
        container.start()
        return container

    def start_cell(self, number):
        config = plain_json(f"{SOURCE}/deploy/kubernetes/cells/lift.json")
        config["dds"]["discovery_servers"] = [f"{self.SERVER}:11811"]
        axis, = config["buses"][0]["drives"][0]["axes"]
        axis.update(axis=number, name=f"lift-{number}")  # its drive is not there, which its topic tells
        with open(f"{self.folder}/{number}.json", "w", encoding="utf-8") as file:
            json.dump(config, file)
        return self.start(f"cell-{number}", "localhost/axisgate-dds", [], "--volume", f"{self.folder}/{number}.json:/etc/axisgate/gateway.json:ro")

    def test_the_topics_of_all_are_found_by_the_server_also_after_its_restart(self):
        server = self.start("discovery", "localhost/axisgate-discovery", [], "--ip", self.SERVER)
        for number in (1, 2):
            self.start_cell(number)
        reader = self.start("reader", "localhost/axisgate-dds", ["topics", "--interface", "eth0", "--discovery-server", f"{self.SERVER}:11811", "--json"],
                            "--entrypoint", '["/usr/bin/axisgate-dds"]')
        self.assert_sees(reader, 1, 2)
        server.kill()
        server.start()
        self.start_cell(3)
        # Each participant takes the server for alive until its lease of 20 s is over, and then looks for it anew.
        self.assert_sees(reader, 3, seconds=10 * NEVER)

    def assert_sees(self, reader, *axes, seconds=NEVER):
        follower = reader.follow()
        self.addCleanup(follower.clean_up)
        for axis in axes:
            follower.sees(f"axis {axis}", lambda told, axis=axis: told.get("name") == f"lift-{axis}", seconds=seconds)
