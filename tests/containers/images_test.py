# SPDX-License-Identifier: Apache-2.0
"""What is in the images, how large they are, and as whom they run. Run by tests/containers/run."""
import json
import os
import re
import subprocess
import sys
import tarfile
import tempfile
import unittest

from engine import LIMITS, Container
from container_stage import ENGINE, SOURCE, USER, plain_json

MB = 1000 * 1000


class Images(unittest.TestCase):
    SHIPPED = {"localhost/axisgate": 30 * MB, "localhost/axisgate-web": 35 * MB, "localhost/axisgate-dds": 60 * MB}
    FROM_NOTHING = [*SHIPPED, "localhost/axisgate-simulator", "localhost/axisgate-discovery"]

    def files(self, image):
        """Names and headers of all that is in it."""
        container = Container(ENGINE, "looked-at")
        self.addCleanup(container.remove)
        container.create([], image, [])
        with tempfile.TemporaryDirectory() as folder:
            ENGINE("export", "--output", f"{folder}/image.tar", container.name)
            with tarfile.open(f"{folder}/image.tar") as archive:
                files = {entry.name.strip("/"): entry for entry in archive if entry.name.strip("./")}
        container.remove()
        return files

    def test_they_are_small(self):
        for image, limit in self.SHIPPED.items():
            with self.subTest(image):
                saved = subprocess.Popen([*ENGINE.command, "save", image], stdout=subprocess.PIPE)
                packed = subprocess.run(["gzip"], stdin=saved.stdout, capture_output=True, check=True).stdout
                saved.stdout.close()
                self.assertEqual(saved.wait(), 0)
                print(f"{image}: {len(packed) / MB:.1f} MB packed", file=sys.stderr)
                self.assertLess(len(packed), limit)

    def test_they_hold_the_programs_and_what_these_need_and_nothing_else(self):
        programs = {"localhost/axisgate": {"axisgate"}, "localhost/axisgate-web": {"axisgate", "axisgate-web"}, "localhost/axisgate-dds": {"axisgate", "axisgate-dds", "axisgate-web"},
                    "localhost/axisgate-simulator": {"axisgate-sim"}, "localhost/axisgate-discovery": {"fast-discovery-server"}}
        # What the container runtime puts in by itself when a container is made.
        made = r"(dev|proc|sys|run|tmp|etc)(/|$)"
        for image in self.FROM_NOTHING:
            with self.subTest(image):
                files = self.files(image)
                executable = {name for name, entry in files.items() if entry.isfile() and name.startswith("usr/bin/")}
                self.assertEqual(executable, {f"usr/bin/{name}" for name in programs[image]})
                other = [name for name, entry in files.items() if entry.isfile() and name not in executable
                         and not re.match(r"usr/lib(64)?/([a-z0-9_]+-linux-gnu[a-z0-9]*/)?(lib|ld-)[^/]*\.so[.0-9]*$", name)
                         and not re.match(r"usr/share/axisgate/schemas/.*\.(json|idl)$", name) and not re.match(made, name)]
                self.assertEqual(other, [])
                self.assertEqual([name for name, entry in files.items() if entry.mode & 0o6000], [], "set-user-id")
                self.assertEqual([name for name, entry in files.items() if entry.mode & 0o002 and not entry.issym()
                                  and not re.match(made, name)], [], "anybody may write these")
        self.assertIn("etc/ssl/certs/ca-certificates.crt", self.files("localhost/axisgate"))

    def test_no_image_runs_as_root_and_the_gateway_says_how_it_is(self):
        for image in [*self.FROM_NOTHING, "localhost/axisgate-client"]:
            with self.subTest(image):
                config = ENGINE.json("image", "inspect", image)[0]["Config"]
                self.assertEqual(config["User"], f"{USER}:{USER}")
        for image in self.SHIPPED:
            config = ENGINE.json("image", "inspect", image)[0]["Config"]
            self.assertEqual(config["StopSignal"], "SIGTERM")
            health = ENGINE.json("image", "inspect", image)[0]["Healthcheck"]["Test"]
            self.assertEqual(health[:3], ["CMD", "/usr/bin/axisgate", "top"])

    def test_the_shipped_profiles_are_found(self):
        with tempfile.TemporaryDirectory() as folder:
            os.chmod(folder, 0o755)
            with open(f"{folder}/gateway.json", "w", encoding="utf-8") as file:
                json.dump(plain_json(f"{SOURCE}/deploy/example/gateway.json"), file)
            done = ENGINE.done("run", "--rm", "--pull=never", "--network", "none", "--read-only", "--cap-drop=all", *LIMITS, "--volume", f"{folder}:/etc/axisgate:ro",
                               "localhost/axisgate", "check", "/etc/axisgate/gateway.json")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_compose_itself_takes_the_file(self):
        done = subprocess.run(["docker-compose", "-f", f"{SOURCE}/deploy/compose.yaml", "config"], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
