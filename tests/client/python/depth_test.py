"""Run by python_client_test.cc against a server on which the sequence "sim" publishes depth."""

import itertools
import os
import unittest

import grpc

import visionserver
from visionserver.v1 import stream_pb2


class Depth(unittest.TestCase):
    def setUp(self):
        self.client = visionserver.connect(os.environ["TEST_ADDRESS"],
                                           fingerprint=os.environ["TEST_FINGERPRINT"],
                                           token=os.environ["TEST_API_KEY"])
        self.addCleanup(self.client.close)

    def test_images_come_one_after_the_other_in_every_codec(self):
        for codec in (stream_pb2.CODEC_RAW, stream_pb2.CODEC_RVL):
            with self.subTest(codec):
                frames = list(itertools.islice(self.client.depth("sim/depth", codec=codec), 4))
                for before, after in zip(frames, frames[1:]):
                    self.assertEqual(before.seq + after.dropped + 1, after.seq)
                self.assertEqual((130, 97), (frames[0].width, frames[0].height))
                self.assertGreater(frames[0].valid_share(), 0.5)

    def test_pixels_are_metres(self):
        frame = next(self.client.depth("sim/depth"))
        places = itertools.product(range(frame.width), range(frame.height))
        x, y = next(place for place in places if frame.depth_m(*place) is not None)
        geometry = frame.geometry
        disparity_px = frame.values[y][x] * frame.scale + frame.offset
        depth_m = (geometry.focal_px * geometry.baseline_m
                   / (disparity_px + geometry.principal_offset_px))
        self.assertAlmostEqual(depth_m, frame.depth_m(x, y))
        self.assertAlmostEqual((x - geometry.cx_px) * depth_m / geometry.focal_px,
                               frame.point_m(x, y)[0])
        self.assertTrue(0.1 < depth_m < 20, depth_m)

    def test_a_robot_may_not_edit(self):
        with self.assertRaises(grpc.RpcError) as caught:
            self.client.call("SequenceService", "DeleteSequence", id="sim")
        self.assertEqual(grpc.StatusCode.PERMISSION_DENIED, caught.exception.code())


if __name__ == "__main__":
    unittest.main()
