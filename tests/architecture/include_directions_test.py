"""The arrows of the house: which folder may include which (README.md, "The house")."""

import fnmatch
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCES = {".h", ".cc", ".cu"}

# folder -> the folders of ours that its files may include, besides itself. The longest matching
# key counts.
ALLOWED = {
    "engine/base": set(),
    "engine/image": {"engine/base"},
    "engine/core": {"engine/image", "engine/base"},
    "engine/calibration": {"engine/image", "engine/base"},
    "engine/stereo": {"engine/image", "engine/base"},
    "engine/camera": {"engine/image", "engine/base"},
    "engine/sim": {"engine/camera", "engine/image", "engine/base"},
    "engine/blocks": {"engine"},
    "gpu": {"engine/base", "engine/image", "engine/stereo"},
    "proto": set(),
    "server": {"engine", "gpu", "proto"},
    "client": {"proto"},
    "web": {"proto"},
    "deploy": set(),
    "tests": {"engine", "gpu", "proto", "server", "client"},
}

# The first-level folders that may hold code.
TOPS = sorted({folder.split("/")[0] for folder in ALLOWED})

# Libraries that only these files may know.
LIBRARIES = {
    r"grpc|grpcpp": {"server/*", "client/*", "tests/*", "proto/*"},
    r"google/protobuf": {"server/*", "client/*", "tests/*", "proto/*"},
    r"sqlite3\.h": {"server/*", "tests/*"},
    r"arv\.h": {"engine/camera/gev_*"},
    r"spdlog": {"engine/base/log.cc"},
    r"CLI": {
        "client/cli/command_line.cc",
        "engine/sim/gevsim/options.cc",
        "server/main.cc",
        "tests/bench/*",
    },
    r"nlohmann": {
        "client/cli/*",
        "engine/calibration/rig_json.cc",
        "engine/core/parse_sequence.cc",
        "engine/core/sequence_spec.cc",
        "server/results/stored_result.cc",
        "server/sequences/stored_sequence.cc",
        "tests/*",
    },
    r"opencv2": {
        "engine/calibration/rectifier.cc",
        "engine/camera/image_file.cc",
        "engine/image/opencv_view.h",
        "engine/sim/gevsim/folder_camera.cc",
        "tests/*",
    },
    r"sodium\.h": {"server/access/*"},
    r"boost": {"gpu/emulation/simt_on_cpu.cc", "server/http/request_reader.cc"},
    r"openssl": {
        "client/certificate.cc",
        "server/http/client_stream.cc",
        "server/http/tls_context.cc",
        "server/transport/certificate.cc",
        "tests/server/http/*",
    },
    r"cuda_runtime(_api)?\.h": {"gpu/cuda_device.h", "gpu/*.cu", "gpu/kernels/simt_on_cuda.h"},
    r"turbojpeg\.h": {"server/streams/jpeg_encoder.cc", "tests/*"},
    r"png\.h": {"client/cli/png_file.cc", "engine/image/png.cc", "tests/*"},
}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def folder_of(path):
    """The key of ALLOWED that `path` belongs to; None when it belongs to none of ours."""
    parts = path.split("/")
    for length in (2, 1):
        key = "/".join(parts[:length])
        if key in ALLOWED and len(parts) > length:
            return key
    return None


def inside(folder, allowed):
    return any(folder == one or folder.startswith(one + "/") for one in allowed)


def faults_of(path, text):
    """What is wrong with the includes of the file `path` (relative to the root)."""
    own = folder_of(path)
    if own is None:
        return [f"{path}: lies in no folder that the table of include directions knows"]
    faults = []
    for number, line in enumerate(text.splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        target = match.group(2)
        other = folder_of(target)
        if other and other != own and not inside(other, ALLOWED[own]):
            faults.append(f"{path}:{number}: {own} must not include {target}")
        if match.group(1) == '"' and other is None and not target.endswith(".pb.h"):
            faults.append(f"{path}:{number}: write {target} with its full path from the root")
        for library, users in LIBRARIES.items():
            known = any(fnmatch.fnmatchcase(path, user) for user in users)
            if re.match(rf"({library})(/|$|\.)", target + "/") and not known:
                faults.append(f"{path}:{number}: {path} must not know {target}")
    return faults


class IncludeDirections(unittest.TestCase):
    def test_every_include_follows_an_arrow(self):
        faults, files = [], 0
        for top in TOPS:
            for path in sorted((ROOT / top).rglob("*")):
                if path.suffix in SOURCES:
                    files += 1
                    faults += faults_of(str(path.relative_to(ROOT)), path.read_text())
        self.assertGreater(files, 20)
        self.assertEqual([], faults, "\n" + "\n".join(faults))

    def test_an_arrow_that_runs_back_up_is_found(self):
        self.assertEqual(1, len(faults_of("engine/base/log.cc", '#include "engine/image/image.h"')))
        self.assertEqual(1, len(faults_of("engine/stereo/a.cc", '#include "engine/core/block.h"')))
        self.assertEqual(1, len(faults_of("engine/core/a.cc", "#include <grpcpp/grpcpp.h>")))
        self.assertEqual(1, len(faults_of("client/a.cc", '#include "engine/base/status.h"')))
        self.assertEqual(1, len(faults_of("engine/core/a.cc", '#include "block.h"')))
        self.assertEqual(1, len(faults_of("deploy/demo/a.cc", '#include "client/address.h"')))
        self.assertEqual(1, len(faults_of("engine/camera/a.cc", "#include <arv.h>")))
        self.assertEqual([], faults_of("engine/camera/gev_a.cc", "#include <arv.h>"))
        self.assertEqual(1, len(faults_of("engine/base/clock.cc", "#include <spdlog/spdlog.h>")))
        self.assertEqual([], faults_of("engine/sim/a.cc", '#include "engine/camera/camera_source.h"'))

    def test_every_second_level_folder_has_a_short_readme(self):
        missing = []
        for top in sorted(set(TOPS) - {"web"}):  # one README tells of all its folders
            for folder in sorted(path for path in (ROOT / top).glob("*") if path.is_dir()):
                if folder.name == "__pycache__":
                    continue
                readme = folder / "README.md"
                if not readme.exists():
                    missing.append(f"{folder.relative_to(ROOT)}: no README.md")
                elif len(readme.read_text().splitlines()) > 20:
                    missing.append(f"{readme.relative_to(ROOT)}: longer than 20 lines")
        self.assertEqual([], missing, "\n" + "\n".join(missing))


if __name__ == "__main__":
    sys.exit(unittest.main())
