#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The Debian packages, unpacked into a folder: units verify and are hardened, no dependency is forgotten, tools run from where they lie.
On a bare machine with apt: tests/packages/on_bare_debian. Under a real systemd: tests/packages/under_systemd.

    packages_test.py FOLDER_OF_DEBS"""

import functools
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

PERCEPTION = ("sensor", "gng", "ladder")
TO_PEOPLE = ("viewer", "relay")
MAX_EXPOSURE = 4.0


def output(*command):
    return subprocess.run(list(map(str, command)), capture_output=True, text=True, check=True).stdout


@functools.cache
def owners_of(library):
    """The packages of this machine that have it."""
    return {line.split(":")[0] for line in output("dpkg", "-S", f"*/{library}").splitlines()}


def field(package, name):
    return output("dpkg-deb", "-f", package, name).strip()


class Packages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.debs = {field(deb, "Package"): deb for deb in sorted(pathlib.Path(DEBS).glob("*.deb"))}
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = pathlib.Path(cls.folder.name)
        for deb in cls.debs.values():
            subprocess.run(["dpkg-deb", "-x", str(deb), str(cls.root)], check=True)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_all_are_there(self):
        """Seven packages of one version; nobody else's file is named twice."""
        self.assertEqual(set(self.debs), {"ladder-robot", "ladder-robot-tools", "ladder-robot-viewer", "ladder-robot-simulator", "ladder-robot-spy",
                                          "ladder-msgs-dev", "libddgng-dev"})
        self.assertEqual(len({field(deb, "Version") for deb in self.debs.values()}), 1)
        files = [name for deb in self.debs.values() for name in output("dpkg-deb", "-c", deb).splitlines() if name.startswith(("-", "l"))]
        names = [line.split()[5] for line in files]
        self.assertEqual(len(names), len(set(names)), "a file is in two packages")

    def test_configuration_files_are_kept(self):
        """What an operator edits is a conffile: an upgrade asks before it replaces."""
        conffiles = output("dpkg-deb", "-I", self.debs["ladder-robot"], "conffiles").split()
        self.assertEqual(conffiles, ["/etc/default/ladder", "/etc/ladder/robot.toml"])
        for name in ("postinst", "prerm", "postrm"):
            script = output("dpkg-deb", "-I", self.debs["ladder-robot"], name)
            subprocess.run(["sh", "-n"], input=script, text=True, check=True)

    def test_no_library_is_forgotten(self):
        """The package of every library that a program needs is among the dependencies of its own package."""
        for package, deb in self.debs.items():
            depends = {re.split(r"[ (]", part.strip())[0] for part in field(deb, "Depends").split(",")}
            for name in output("dpkg-deb", "-c", deb).splitlines():
                path = self.root / name.split()[5]
                if not name.startswith("-rwx") or path.read_bytes()[:4] != b"\x7fELF":
                    continue
                for library in re.findall(r"NEEDED\s+(\S+)", output("objdump", "-p", path)):
                    with self.subTest(f"{path.name}: {library}"):
                        self.assertTrue(owners_of(library) & depends, f"{package} does not depend on any of {owners_of(library)}")

    def test_units_verify(self):
        """systemd finds nothing wrong with the units and the programs that they name."""
        units = sorted(path.name for path in (self.root / "usr/lib/systemd/system").iterdir())
        self.assertEqual(len(units), 9)
        got = subprocess.run(["systemd-analyze", f"--root={self.root}", "verify", "--recursive-errors=no", "--man=no",
                              *[unit.replace("@.", "@eth1.") for unit in units]], capture_output=True, text=True, check=False)
        # Of the host's tools the folder has none.
        said = [line for line in got.stderr.splitlines() if "ladder" in line and "/usr/sbin/ip" not in line and "systemd-sysctl" not in line]
        self.assertEqual(said, [])

    def test_hardening(self):
        """All are exposed by 4.0 at most, by systemd's own measure; the controller alone has real-time rights."""
        for service in (*PERCEPTION, *TO_PEOPLE, "climb"):
            unit = self.root / f"usr/lib/systemd/system/ladder-{service}.service"
            text = unit.read_text()
            exposure = float(re.search(r"exposure level for \S+: ([\d.]+)", output("systemd-analyze", "security", "--offline=true", "--no-pager", unit))[1])
            print(f"ladder-{service}.service: exposure {exposure}", file=sys.stderr)
            self.assertLessEqual(exposure, MAX_EXPOSURE)
            self.assertEqual("LimitRTPRIO" in text or "CPUScheduling" in text, service == "climb")
            self.assertEqual("AF_CAN" in text, service == "climb")
            self.assertIn("RestartPreventExitStatus=2", text)
            self.assertIn("IPAddressAllow=localhost 239.255.76.67", text)

    def test_tools_run_from_where_they_lie(self):
        """ladder-log and ladder-doctor find their modules, types and the services beside them."""
        self.assertIn("usage: ladder-log", output(self.root / "usr/bin/ladder-log", "--help"))
        with tempfile.NamedTemporaryFile() as empty:
            got = subprocess.run([self.root / "usr/bin/ladder-log", "check", empty.name], capture_output=True, text=True, check=False)
        self.assertEqual((got.returncode, got.stderr), (1, "no events: the file is empty\n"))
        programs = self.root / "usr/libexec/ladder"
        got = subprocess.run([self.root / "usr/bin/ladder-doctor", "--only", "configuration", "--programs", programs, "--config", self.root / "etc/ladder/robot.toml"],
                             capture_output=True, text=True, check=False)
        self.assertEqual((got.returncode, got.stdout), (0, "ok       configuration: every service accepts it\n"))

    def test_viewer_finds_its_page(self):
        """The page lies where the installed viewer looks for it."""
        page = self.root / "usr/share/ladder/viewer"
        self.assertIn(f"--page TEXT={page}\n", output(self.root / "usr/bin/ladder_viewer", "--help"))
        for name in ("index.html", "page.js", "page.css", "third_party_licences.txt"):
            self.assertGreater((page / name).stat().st_size, 0, name)

    def test_python_messages(self):
        """The installed Python codecs can be imported and know the types."""
        said = output(sys.executable, "-B", "-c", f"import sys; sys.path.insert(0, '{self.root}/usr/lib/python3/dist-packages'); "
                      "import ladder_msgs; print(len(ladder_msgs.pose_t().encode()))")
        self.assertGreater(int(said), 8)


if __name__ == "__main__":
    DEBS = sys.argv.pop(1)
    unittest.main()
