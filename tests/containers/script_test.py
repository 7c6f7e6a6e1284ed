#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""deploy/container/cell reads deploy/compose.yaml whole, and refuses what it does not know; the simulator's terminals are where it is told.

script_test.py SOURCE_FOLDER AXISGATE_SIM [unittest's arguments]
"""
import importlib.machinery
import importlib.util
import os
import subprocess
import sys
import tempfile
import unittest

import yaml

SOURCE, SIMULATOR = (os.path.abspath(path) for path in sys.argv[1:3])
sys.path.insert(0, f"{SOURCE}/tests/integration")
from processes import Program  # noqa: E402

# In a mount namespace of its own; where a devpts is mounted, and nothing else is of use.
OWN = ["unshare", "--mount", *([] if os.geteuid() == 0 else ["--map-root-user"]), "sh", "-c"]


def script():
    loader = importlib.machinery.SourceFileLoader("cell", f"{SOURCE}/deploy/container/cell")
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("cell", loader))
    loader.exec_module(module)
    return module


CELL = script()


class InAFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-cell-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name


class Words(InAFolder):
    def setUp(self):
        super().setUp()
        with open(f"{SOURCE}/deploy/compose.yaml", encoding="utf-8") as file:
            self.told = yaml.safe_load(file)

    def set(self):
        path = f"{self.folder}/compose.yaml"
        with open(path, "w", encoding="utf-8") as file:
            yaml.safe_dump(self.told, file, sort_keys=False)
        return CELL.Set(path)

    def refused(self):
        with self.assertRaises(CELL.Failed) as failed:
            cell = self.set()
            for service in cell.services:
                cell.needed(service)
                cell.words(service)
        return str(failed.exception)

    def test_every_key_of_the_shipped_file_is_carried_out(self):
        cell = CELL.Set(CELL.FILE)
        self.assertGreater(len(cell.services), 3)
        for service in cell.services:
            words = cell.words(service)
            for sealed in ("--read-only", "--cap-drop=ALL", "--security-opt=no-new-privileges=true", "--restart"):
                self.assertIn(sealed, words, service)
        gateway = cell.words("gateway")
        self.assertIn("127.0.0.1:1502:1502", gateway)
        self.assertIn(f"{SOURCE}/deploy/./container/compose.json:/etc/axisgate/gateway.json:ro", gateway)
        self.assertEqual(gateway[gateway.index("--stop-timeout") + 1], "10")
        neighbour = cell.words("neighbour")
        self.assertEqual([neighbour[neighbour.index(option) + 1] for option in ("--network", "--ipc")], ["container:cell_gateway"] * 2)
        self.assertEqual(cell.needed("plc"), {"gateway": True})
        self.assertEqual(cell.needed("neighbour"), {"gateway": False})

    def test_the_terminals_lie_where_no_container_has_a_mount_of_its_own(self):
        """Of two mounts at one place podman lays now one, now the other on top."""
        own = ("/dev", "/proc", "/sys", "/run", "/etc/hosts", "/etc/resolv.conf")
        cell = CELL.Set(CELL.FILE)
        for service in cell.services:
            words = cell.words(service)
            mounts = [words[at + 1].split(":") for at, word in enumerate(words) if word == "--volume"]
            self.assertEqual([target for _, target, *_ in mounts if target.startswith(own)], [], service)
            for source, _, *how in mounts:
                self.assertEqual(source.startswith("cell_"), "dev" in how, "a volume's terminals can be opened, and of no other mount")
        simulator = self.told["services"]["simulator"]
        self.assertEqual({f"terminals:{simulator['command'][simulator['command'].index('--terminals') + 1]}"} - set(simulator["volumes"]), set())

    def test_what_it_does_not_know_is_refused_by_its_name(self):
        for change, named in ((lambda told: told["services"]["gateway"].update(privileged=True), "services.gateway.privileged"),
                              (lambda told: told.update(secrets={}), "secrets"),
                              (lambda told: told["services"]["plc"].update(healthcheck={"test": "true"}), "services.plc.healthcheck"),
                              (lambda told: told["services"]["plc"].update(depends_on={"gateway": {"condition": "service_completed_successfully"}}),
                               "services.plc.depends_on.gateway"),
                              (lambda told: told["services"]["simulator"].update(depends_on=["plc"]), "services.simulator.depends_on"),
                              (lambda told: told["services"]["gateway"].update(stop_grace_period="1m"), "1m")):
            self.setUp()
            change(self.told)
            self.assertIn(named, self.refused())


class Terminals(InAFolder):
    def simulator(self, before):
        program = Program("axisgate-sim", [*OWN, f'{before} && exec "$0" --line "$1/lift:jd@1" --terminals "$1/terminals"', SIMULATOR, self.folder])
        self.addCleanup(program.clean_up)
        return program

    def test_are_those_of_the_folder(self):
        os.mkdir(f"{self.folder}/terminals")
        for left in ("terminals/17", "/dev/pts/17"):  # by a simulator that was killed
            os.symlink(f"{self.folder}/{left}" if left.startswith("t") else left, f"{self.folder}/lift")
            program = self.simulator(f'mount -t devpts -o ptmxmode=0666,mode=0660 devpts {self.folder}/terminals')
            program.wait_for(f"^ready {self.folder}/lift -> {self.folder}/terminals/0 ")
            self.assertEqual(os.readlink(f"{self.folder}/lift"), f"{self.folder}/terminals/0")
            self.assertEqual(program.terminate(), 0)
            self.assertFalse(os.path.lexists(f"{self.folder}/lift"))

    def test_a_link_that_is_the_users_own_stays(self):
        os.mkdir(f"{self.folder}/terminals")
        os.symlink(f"{self.folder}/terminals-of-mine", f"{self.folder}/lift")
        program = self.simulator(f'mount -t devpts -o ptmxmode=0666,mode=0660 devpts {self.folder}/terminals')
        self.assertEqual(program.ended(), 1)
        program.wait_for("lift is a link to something else")
        self.assertEqual(os.readlink(f"{self.folder}/lift"), f"{self.folder}/terminals-of-mine")

    def test_a_folder_without_a_devpts_is_named(self):
        program = self.simulator("true")
        self.assertEqual(program.ended(), 1)
        program.wait_for(f"cannot open {self.folder}/terminals/ptmx .*devpts")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
