#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What deploy/package makes of a build folder: packages with all that they should hold, that need no more than they say.

debs_test.py SOURCE_FOLDER BUILD_FOLDER [unittest's arguments]
"""
import gzip
import hashlib
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from installed_commands import MANUAL, Installed

SOURCE, BUILD = (Path(folder).absolute() for folder in sys.argv[1:3])
sys.path.insert(0, f"{SOURCE}/tests/docs")
from page_commands import of_page  # noqa: E402 where the pages are read

GATEWAY, DDS, WEB, SIMULATOR = "axisgate", "axisgate-dds", "axisgate-web", "axisgate-sim"
OF_EACH = ("bin/{0}", "share/man/man1/{0}.1.gz", "share/bash-completion/completions/{0}", "share/zsh/vendor-completions/_{0}",
           "share/doc/{0}/copyright", "share/doc/{0}/changelog.gz", "share/doc/{0}/changelog.Debian.gz")
SCRIPTS = tuple(f"/usr/share/doc/axisgate/deploy/{name}" for name in ("container/cell", "kubernetes/render"))
OF_ONE = {
    GATEWAY: ("/lib/systemd/system/axisgate.service", "/lib/udev/rules.d/71-axisgate-lines.rules", "/etc/axisgate/",
              "/usr/share/man/man5/gateway.json.5.gz", "/usr/share/axisgate/schemas/gateway.schema.json",
              "/usr/share/axisgate/schemas/drive-profile.schema.json", "/usr/share/doc/axisgate/examples/gateway.json",
              "/usr/share/doc/axisgate/examples/70-axisgate.rules", "/usr/share/doc/axisgate/examples/80-can0.network",
              "/usr/share/doc/axisgate/SECURITY.md", "/usr/share/doc/axisgate/docs/installation.md", "/usr/share/doc/axisgate/docs/README.md",
              "/usr/share/doc/axisgate/docs/drives/kinco-jd.md", "/usr/share/doc/axisgate/docs/dds/ros2.md",
              "/usr/share/doc/axisgate/deploy/plc/axisgate.st", "/usr/share/doc/axisgate/deploy/plc/axisgate.xml",
              "/usr/share/doc/axisgate/deploy/examples/modbus/gateway.json", "/usr/share/doc/axisgate/deploy/examples/node-red/flow.json",
              "/usr/share/doc/axisgate/deploy/examples/new_drive/acme-servo.eds", "/usr/share/doc/axisgate/docs/demo.svg",
              *SCRIPTS, "/usr/share/doc/axisgate/deploy/compose.yaml", "/usr/share/doc/axisgate/deploy/container/compose.json"),
    DDS: ("/usr/share/axisgate/schemas/axisgate.idl", "/usr/share/doc/axisgate-dds/examples/axisgate-dds.nft",
          "/usr/share/doc/axisgate-dds/examples/README.md"),
    WEB: tuple(f"/usr/share/axisgate/monitoring/{name}" for name in ("prometheus.yml", "rules.yml", "dashboard.json", "alertmanager.yml")),
    SIMULATOR: (),
}


def anchors(page):
    """As GitHub makes them from headings."""
    text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in re.findall(r"^#+ (.*)$", text, re.MULTILINE)}


def output(*command, **options):
    done = subprocess.run(command, capture_output=True, text=True, **options)
    assert done.returncode == 0, f"{command}: {done.returncode}\n{done.stdout}{done.stderr}"
    return done.stdout


def make(folder, *options, **environment):
    done = subprocess.run([SOURCE / "deploy/package", "--built", BUILD, *options, folder], capture_output=True, text=True,
                          env={**os.environ, **environment})
    if done.returncode:
        raise AssertionError(f"deploy/package has failed:\n{done.stdout}{done.stderr}")
    debs = {output("dpkg-deb", "-f", line, "Package").strip(): Path(line) for line in done.stdout.splitlines()}
    assert len(debs) == len(done.stdout.splitlines())
    return debs


class Debs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-debs-")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.debs = make(cls.folder / "debs", SOURCE_DATE_EPOCH="1700000000")
        cls.files = {}
        for name, deb in cls.debs.items():
            lines = [line.split(maxsplit=5) for line in output("dpkg-deb", "-c", deb).splitlines()]
            cls.files[name] = {line[5].removeprefix("."): (line[0], line[1]) for line in lines}
            subprocess.run(["dpkg-deb", "-x", deb, cls.folder / name], check=True)

    def field(self, package, name):
        return output("dpkg-deb", "-f", self.debs[package], name).strip()

    def read(self, package, path):
        path = self.folder / package / path.lstrip("/")
        return gzip.open(path, "rt").read() if path.suffix == ".gz" else path.read_text(encoding="utf-8")

    def test_there_are_four_and_each_holds_its_files(self):
        self.assertEqual(set(self.debs), {GATEWAY, DDS, WEB, SIMULATOR})
        for name, files in self.files.items():
            expected = {"/usr/" + path.format(name) for path in OF_EACH} | set(OF_ONE[name])
            self.assertEqual(expected - set(files), set(), name)
        shipped = {path.name for path in (SOURCE / "schemas/drives").glob("*.json")}
        held = {Path(path).name for path in self.files[GATEWAY] if "/schemas/drives/" in path and path.endswith(".json")}
        self.assertEqual(held, shipped)

    def test_every_page_is_there(self):
        folder = self.folder / GATEWAY / "usr/share/doc/axisgate"
        made = {path.relative_to(SOURCE).as_posix() for path in (SOURCE / "docs").rglob("*.md")}
        self.assertEqual(made - {path.relative_to(folder).as_posix() for path in folder.rglob("*.md")}, set())

    def test_no_link_of_an_installed_page_is_dead(self):
        """Each package by itself: what it links to it has, inside its own documents, or it is on the web."""
        dead, counted = [], 0
        for name in self.debs:
            folder = (self.folder / name / "usr/share/doc" / name).resolve()
            for page in sorted(folder.rglob("*.md")):
                text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)
                for target in re.findall(r"\]\(([^)\s]+)\)", text):
                    path, _, anchor = target.partition("#")
                    other = (page.parent / path).resolve() if path else page
                    counted += 1
                    if "://" in target or target.startswith("mailto:"):
                        continue
                    if not other.exists() or not other.is_relative_to(folder):
                        dead.append(f"{name}: {page.relative_to(folder)}: {target}")
                    elif anchor and anchor not in anchors(other):
                        dead.append(f"{name}: {page.relative_to(folder)}: {target}: no heading is called so")
        self.assertEqual(dead, [])
        self.assertGreater(counted, 200)

    def test_the_examples_of_dds_are_built_where_they_are_installed_and_from_a_copy(self):
        """Those of Cyclone DDS, which take seconds; both vendors' are configured and take the same file."""
        installed = self.folder / DDS / "usr/share/doc/axisgate-dds/examples"
        idl = (self.folder / DDS / "usr/share/axisgate/schemas/axisgate.idl").resolve()
        typed = of_page("deploy/examples/dds/README.md", "cp -r /usr/share/doc/axisgate-dds/examples").replace("/usr/", f"{self.folder / DDS}/usr/")
        subprocess.run(["sh", "-c", typed], check=True, cwd=self.folder)
        copied = self.folder / "dds-examples"
        for number, (source, options) in enumerate(((installed, ()), (copied, (f"-DCMAKE_FIND_ROOT_PATH={self.folder / DDS}",)))):
            with self.subTest(source.name):
                build = self.folder / f"built-{number}"
                output("cmake", "-S", source, "-B", build, *options)
                found = re.search(r"^AXISGATE_IDL:FILEPATH=(.*)$", (build / "CMakeCache.txt").read_text(encoding="utf-8"), re.MULTILINE)[1]
                self.assertEqual(Path(found).resolve(), idl)
                output("cmake", "--build", build, "--target", "axes_cyclonedds", "command_cyclonedds")
                self.assertIn("usage: command_cyclonedds", subprocess.run([build / "command_cyclonedds"], capture_output=True, text=True, check=False).stderr)
        nowhere = self.folder / "nowhere"
        nowhere.mkdir()
        done = subprocess.run(["cmake", "-S", copied, "-B", self.folder / "built-not", f"-DCMAKE_FIND_ROOT_PATH={nowhere}", "-DCMAKE_FIND_ROOT_PATH_MODE_INCLUDE=ONLY"],
                              capture_output=True, text=True, check=False)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("-DAXISGATE_IDL=", re.sub(r"\s+", " ", done.stderr))

    def test_no_file_is_in_two_of_them_or_where_it_has_no_business(self):
        everything = [path for files in self.files.values() for path in files if not path.endswith("/")]
        self.assertEqual(len(everything), len(set(everything)))
        odd = [path for path in everything if not re.match(r"/usr/(bin/axisgate|share/(axisgate|man|doc|bash-completion|zsh)/)|/lib/", path)]
        self.assertEqual(odd, [])

    def test_files_are_roots_and_others_cannot_write_them(self):
        for files in self.files.values():
            for path, (mode, owner) in files.items():
                right = "drwxr-xr-x" if path.endswith("/") else "-rwxr-xr-x" if path.startswith("/usr/bin/") or path in SCRIPTS else "-rw-r--r--"
                self.assertEqual((mode, owner), (right, "root/root"), path)

    def test_only_axisgate_dds_needs_the_dds_library(self):
        version = self.field(GATEWAY, "Version")
        self.assertRegex(self.field(DDS, "Depends"), r"libfastrtps")
        self.assertIn(f"axisgate (= {version})", self.field(DDS, "Depends"))
        self.assertIn(f"axisgate (= {version})", self.field(WEB, "Depends"))
        self.assertIn("libseccomp2", self.field(WEB, "Depends"))
        self.assertIn("libprometheus-cpp-core1.0", self.field(WEB, "Depends"))
        self.assertNotRegex(self.field(WEB, "Depends"), "prometheus-cpp-pu")
        for name in (GATEWAY, WEB, SIMULATOR):
            needed = self.field(name, "Depends")
            self.assertRegex(needed, r"libc6 \(>= ")
            self.assertNotRegex(needed, "fast|axisgate-dds" if name == WEB else "fast|axisgate-dds|axisgate-web|seccomp|prometheus")
            self.assertNotRegex(self.field(name, "Recommends"), ".")
        self.assertIn("libmodbus5", self.field(GATEWAY, "Depends"))
        self.assertIn("adduser", self.field(GATEWAY, "Depends"))

    def test_no_configuration_is_brought_along(self):
        """A gateway that starts with an example could move somebody's motor."""
        self.assertEqual([path for path in self.files[GATEWAY] if path.startswith("/etc/") and not path.endswith("/")], [])

    def test_the_unit_and_the_manual_pages_are_those_of_this_version(self):
        self.assertEqual(self.read(GATEWAY, "/lib/systemd/system/axisgate.service"),
                         (SOURCE / "deploy/systemd/axisgate.service").read_text(encoding="utf-8"))
        for name in self.debs:
            program = self.folder / name / "usr/bin" / name
            self.assertEqual(self.read(name, f"/usr/share/man/man1/{name}.1.gz"), output(program, "--generate", "man"))
            self.assertEqual(self.read(name, f"/usr/share/bash-completion/completions/{name}"), output(program, "--generate", "bash"))
            self.assertEqual(self.read(name, f"/usr/share/zsh/vendor-completions/_{name}"), output(program, "--generate", "zsh"))
            first = self.read(name, f"/usr/share/doc/{name}/changelog.Debian.gz").splitlines()[0]
            self.assertTrue(first.startswith(f"{name} ({self.field(name, 'Version')}) "), first)

    def test_gateway_json_5_has_each_key_of_a_configuration(self):
        page = self.read(GATEWAY, "/usr/share/man/man5/gateway.json.5.gz")
        self.assertEqual(page, output(self.folder / GATEWAY / "usr/bin" / GATEWAY, "--generate", "gateway.json"))
        schema = json.loads((SOURCE / "schemas/gateway.schema.json").read_text(encoding="utf-8"))

        def keys(node):
            for key, value in node.get("properties", {}).items():
                yield from (key, *keys(value)) if not key.startswith("$") else ()
            for value in (*([node["items"]] if "items" in node else []), *node.get("definitions", {}).values()):
                yield from keys(value)

        self.assertEqual(set(re.findall(r"^\.TP\n\\fB(\S+)\\fR ", page, re.MULTILINE)), set(keys(schema)))
        self.assertGreater(page.count("Example: "), 100)

    def test_the_programs_find_their_profiles_where_they_are_unpacked(self):
        config = {"modbus_tcp": [{"listen": "127.0.0.1:1502"}], "buses": [{"name": "lift", "adapter": "kinco-serial", "device": "/dev/axisgate/lift",
                             "drives": [{"profile": "kinco-jd", "node": 1, "constants": {"peak_current_a": 27.5}, "axes": [{"axis": 1}]}]}]}
        path = self.folder / "gateway.json"
        path.write_text(json.dumps(config), encoding="utf-8")
        self.assertIn("lift", output(self.folder / GATEWAY / "usr/bin/axisgate", "check", path))

    def test_the_configuration_of_the_page_of_containers_is_valid(self):
        path = self.folder / "one-gateway.json"
        path.write_text(re.search(r"^```json\n(.*?)^```", self.read(GATEWAY, f"/{MANUAL}/docs/containers.md"), re.MULTILINE | re.DOTALL)[1], encoding="utf-8")
        self.assertIn("is valid", output(self.folder / GATEWAY / "usr/bin/axisgate", "check", path))

    def test_the_scripts_for_containers_find_what_they_need_beside_them(self):
        folder = self.folder / GATEWAY / MANUAL / "deploy"
        self.assertIn('"StatefulSet"', output(folder / "kubernetes/render", folder / "kubernetes/cells.json"))
        done = subprocess.run([folder / "container/cell", "up", "--without", "nothing"], capture_output=True, text=True, check=False)
        self.assertRegex(done.stderr, "--without nothing: no service of .*/deploy/compose.yaml, which has simulator, gateway,")

    def unpacked(self):
        return Installed([self.folder / name for name in self.debs], lambda path, *words: output(*self.program(path, *words)))

    def program(self, path, *words):
        return [next(str(found) for name in self.debs if (found := self.folder / name / path.lstrip("/")).exists()), *words]

    def test_each_command_of_the_manual_is_one_of_the_packages(self):
        count, wrong = self.unpacked().mistakes()
        self.assertEqual(wrong, [], "\n".join(wrong))
        self.assertGreater(count, 150)

    def test_a_command_that_no_package_has_is_found(self):
        unpacked, page = self.unpacked(), Path("deploy/examples/README.md")
        for words in (["axisgate", "top", "--wrong"], ["axisgate", "profile", "try", "--wrong"], ["axisgate-mqtt"], ["man", "axisgate-mqtt"], ["deploy/nothing"],
                      ["deploy/examples/dds/nothing"], ["cp", "/usr/share/doc/axisgate/examples/nothing.json", "x"], ["sh", "README.md.sh"]):
            wrong = unpacked.wrong_with(page, words)
            self.assertEqual(bool(wrong), words[0] != "sh", words)

    def test_the_manual_shows_what_the_unpacked_programs_do(self):
        """Its short pages, typed as a reader does, by the story that types those of the sources; tests/packages/run has them all typed."""
        story = ["/usr/bin/python3", "-B", SOURCE / "tests/integration/manual_test.py", *self.program("/usr/bin/axisgate"),
                 *self.program("/usr/bin/axisgate-sim"), self.folder / GATEWAY / MANUAL]
        typing = [subprocess.Popen([*map(str, story), *(f"Manual.test_{page}" for page in pages)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
                  for pages in (["quick_start"], ["panels", "examples", "upgrade"])]
        for typed in typing:
            said, _ = typed.communicate()
            self.assertEqual(typed.returncode, 0, said)

    def test_a_release_has_the_same_packages_and_all_else_of_its_page(self):
        """One source and one time: the packages are those that were made before, byte for byte."""
        version, changes = re.search(r"^## (\d\S*)[^\n]*\n(.*?)^## ", (SOURCE / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL).groups()
        folder = self.folder / "release"
        done = subprocess.run([SOURCE / "deploy/package", "--built", BUILD, "--version", version, "--release", "--no-images", folder], capture_output=True,
                              text=True, env={**os.environ, "SOURCE_DATE_EPOCH": "1700000000"})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("without images", done.stderr)
        debs = {output("dpkg-deb", "-f", deb, "Package").strip(): deb for deb in folder.glob("*.deb")}
        self.assertEqual({path.name for path in folder.iterdir()} - {deb.name for deb in debs.values()},
                         {f"notes-{version}.md", f"axisgate-{version}.spdx.json", "SHA256SUMS"})
        before = self.debs if version == self.field(GATEWAY, "Version").removesuffix("-1") else make(self.folder / "before", "--version", version, SOURCE_DATE_EPOCH="1700000000")
        for name, deb in before.items():
            self.assertEqual(debs[name].read_bytes(), deb.read_bytes(), name)
        self.assertEqual(output(*of_page("docs/release.md", "sha256sum").split(), cwd=folder).count(": OK"), len(debs) + 2)
        self.assertEqual((folder / f"notes-{version}.md").read_text(encoding="utf-8"), changes)
        self.check_sbom(json.loads((folder / f"axisgate-{version}.spdx.json").read_text(encoding="utf-8")), debs)

    def check_sbom(self, sbom, debs):
        self.assertEqual((sbom["spdxVersion"], sbom["dataLicense"], sbom["creationInfo"]["created"]), ("SPDX-2.3", "CC0-1.0", "2023-11-14T22:13:20Z"))
        packages, files = ({one["SPDXID"]: one for one in sbom[kind]} for kind in ("packages", "files"))
        self.assertEqual(len(packages) + len(files), len(sbom["packages"]) + len(sbom["files"]), "each identity is one's own")
        related = [(one["spdxElementId"], one["relationshipType"], one["relatedSpdxElement"]) for one in sbom["relationships"]]
        for one, _, other in related:
            self.assertTrue({one, other} <= {"SPDXRef-DOCUMENT", *packages, *files}, (one, other))
        for name, deb in debs.items():
            identity = next(other for _, how, other in related if how == "DESCRIBES" and packages[other]["name"] == name)
            self.assertEqual(packages[identity]["checksums"][0]["checksumValue"], hashlib.sha256(deb.read_bytes()).hexdigest())
            held = {files[other]["fileName"][1:]: files[other]["checksums"] for one, how, other in related if (one, how) == (identity, "CONTAINS")}
            self.assertEqual(set(held), {path for path in self.files[name] if not path.endswith("/")})
            data = (self.folder / name / "usr/bin" / name).read_bytes()
            self.assertEqual({one["algorithm"]: one["checksumValue"] for one in held[f"/usr/bin/{name}"]},
                             {"SHA1": hashlib.sha1(data).hexdigest(), "SHA256": hashlib.sha256(data).hexdigest()})
            needed = {packages[other]["name"]: packages[other]["versionInfo"] for one, how, other in related if (one, how) == (identity, "DEPENDS_ON")}
            self.assertEqual(set(needed), {one.split()[0] for one in self.field(name, "Depends").split(", ")})
            library = "libfmt9"
            self.assertEqual(needed.get(library, ""), output("dpkg-query", "-W", "-f", "${Version}", library) if library in needed else "")
            inside = {packages[one]["name"] for one, how, other in related if (how, other) == ("BUILD_DEPENDENCY_OF", identity)}
            self.assertTrue({"libboost1.81-dev", "libvalijson-dev"} <= inside)
            self.assertEqual("libfastrtps-dev" in inside, name == DDS)

    def test_no_program_tells_where_it_was_compiled(self):
        for name in self.debs:
            data = (self.folder / name / "usr/bin" / name).read_bytes()
            for folder in (SOURCE, BUILD):
                self.assertNotIn(bytes(folder), data, name)

    def test_a_release_that_lacks_something_is_refused_before_anything_is_made(self):
        tools = self.folder / "few-tools"
        tools.mkdir()
        for tool in ("bash", "env", "dirname", "basename", "sed", "awk", "grep", "ls", "cat", "mkdir"):
            (tools / tool).symlink_to(f"/usr/bin/{tool}")
        full = self.folder / "full"
        full.mkdir()
        (full / "old.deb").touch()
        for options, environment, says in ((["--version", "77.1"], {}, "CHANGELOG.md says nothing of 77.1"),
                                           (["--version", "0.2.0"], {"PATH": str(tools)}, "leave the images out with --no-images"),
                                           (["--version", "0.2.0", "--no-images", full], {}, "is not empty")):
            out = self.folder / "refused"
            done = subprocess.run([SOURCE / "deploy/package", "--built", BUILD, "--release", *(options if full in options else [*options, out])],
                                  capture_output=True, text=True, env={**os.environ, **environment})
            self.assertEqual(done.returncode, 1, done.stderr)
            self.assertIn(says, done.stderr)
            self.assertFalse(out.exists())

    def test_another_version_is_another_version_everywhere(self):
        newer = make(self.folder / "newer", "--version", "77.1")
        self.assertEqual({output("dpkg-deb", "-f", deb, "Version").strip() for deb in newer.values()}, {"77.1-1"})
        self.assertIn("axisgate (= 77.1-1)", output("dpkg-deb", "-f", newer[DDS], "Depends"))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
