"""Run by python_client_test.cc against a server that cuts the stream while an image is worked on."""

import os
import pathlib
import time
import unittest

import grpc

import visionserver

GO_ON = pathlib.Path(os.environ["TEST_FOLDER"])


class Reconnect(unittest.TestCase):
    def test_images_go_on_until_the_server_refuses(self):
        received = 0
        with visionserver.connect(os.environ["TEST_ADDRESS"], plaintext=True) as client:
            with self.assertRaises(grpc.RpcError) as caught:
                for frame in client.depth("sequence/depth"):
                    received += 1
                    print(f"image {received} is number {frame.seq}", flush=True)
                    while not (GO_ON / str(received)).exists():
                        time.sleep(0.01)
        self.assertEqual(grpc.StatusCode.UNAUTHENTICATED, caught.exception.code())
        self.assertEqual(3, received)

    def test_a_server_that_was_never_there_is_told(self):
        with visionserver.connect("127.0.0.1:1", plaintext=True) as client:
            with self.assertRaises(grpc.RpcError) as caught:
                next(client.depth("sequence/depth"))
        self.assertEqual(grpc.StatusCode.UNAVAILABLE, caught.exception.code())


if __name__ == "__main__":
    unittest.main()
