"""The Python decoder is bound by the same vectors as all others."""

import json
import pathlib
import unittest

from visionserver import rvl

VECTORS = pathlib.Path(__file__).parents[2] / "proto/wire/vectors/rvl.json"


class Rvl(unittest.TestCase):
    def setUp(self):
        self.vectors = json.loads(VECTORS.read_text())

    def test_images_unpack_as_written(self):
        self.assertGreaterEqual(len(self.vectors["images"]), 9)
        for image in self.vectors["images"]:
            with self.subTest(image["name"]):
                unpacked = rvl.decode(bytes.fromhex(image["rvl"]), image["width"] * image["height"])
                self.assertEqual(image["pixels"], list(unpacked))

    def test_faults_are_refused(self):
        self.assertGreaterEqual(len(self.vectors["faults"]), 12)
        for fault in self.vectors["faults"]:
            with self.subTest(fault["name"]), self.assertRaises(ValueError):
                rvl.decode(bytes.fromhex(fault["rvl"]), fault["width"] * fault["height"])


if __name__ == "__main__":
    unittest.main()
