"""What configuring does about the page of the browser (option VS_WEB) where it cannot be built."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

WEB = pathlib.Path(__file__).resolve().parents[2] / "web"
CMAKE = shutil.which("cmake")
NINJA = shutil.which("ninja")

OLD_NODE = "#!/bin/sh\necho v18.20.4\n"


class WebOption(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name)
        # The only programs on the PATH besides the shell's own.
        self.path = self.root / "path"
        self.path.mkdir()
        (self.root / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\n"
            "project(Page LANGUAGES NONE)\n"
            f'add_subdirectory("{WEB}" web)\n'
            "if(TARGET web)\n  message(FATAL_ERROR \"a page would be built\")\nendif()\n"
        )

    def tearDown(self):
        self.folder.cleanup()

    def program(self, name, text):
        file = self.path / name
        file.write_text(text)
        file.chmod(0o755)

    def configure(self, option):
        """Gives exit code and output."""
        done = subprocess.run(
            [CMAKE, "-G", "Ninja", f"-DCMAKE_MAKE_PROGRAM={NINJA}", f"-DVS_WEB={option}",
             "-S", self.root, "-B", self.root / "build"],
            env={**os.environ, "PATH": str(self.path)},
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False,
        )
        return done.returncode, " ".join(done.stdout.split())

    def test_off_asks_for_nothing(self):
        code, output = self.configure("OFF")
        self.assertEqual(code, 0, output)
        self.assertNotIn("page of the browser", output)

    def test_without_npm_the_rest_is_built_and_it_is_said(self):
        code, output = self.configure("AUTO")
        self.assertEqual(code, 0, output)
        self.assertIn("Building without the page of the browser: there is no npm on the PATH", output)

    def test_on_insists(self):
        code, output = self.configure("ON")
        self.assertNotEqual(code, 0, output)
        self.assertIn("VS_WEB=ON, but there is no npm on the PATH", output)

    def test_without_network_the_reason_is_told(self):
        self.program("node", OLD_NODE)
        self.program("npm", "#!/bin/sh\necho 'npm ERR! reason: getaddrinfo EAI_AGAIN' >&2\nexit 1\n")
        code, output = self.configure("AUTO")
        self.assertEqual(code, 0, output)
        self.assertIn("Node 18.20.4 is older than 20.19, and no newer one came: "
                      "npm ERR! reason: getaddrinfo EAI_AGAIN", output)

    def test_a_node_with_another_content_is_thrown_away(self):
        self.program("node", OLD_NODE)
        # npm pack --silent --pack-destination FOLDER PACKAGE@VERSION
        self.program("npm", "#!/bin/sh\n"
                            'package=${5%@*} version=${5#*@}\n'
                            'echo something else > "$4/$package-$version.tgz"\n')
        code, output = self.configure("AUTO")
        self.assertEqual(code, 0, output)
        self.assertIn("came with another content than is known of it", output)
        self.assertEqual(list((self.root / "build").rglob("*.tgz")), [])
        self.assertEqual(list((self.root / "build").rglob("package")), [])


if __name__ == "__main__":
    unittest.main()
