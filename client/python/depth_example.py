#!/usr/bin/python3
"""Prints what lies in the middle of the depth images of a running sequence.

    VISIONSERVER_TOKEN=API_KEY build/release/client/python/depth_example.py \\
        --server cell-7 --fingerprint AB:CD:... stereo_depth/depth

The API key comes from `visionctl keys create NAME`. Elsewhere, set PYTHONPATH to the folder that
holds the package visionserver.
"""

import argparse
import itertools
import os
import sys

import grpc

import visionserver


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("stream", help="such as stereo_depth/depth")
    parser.add_argument("--server", default="localhost", metavar="HOST[:PORT]")
    parser.add_argument("--ca", metavar="FILE", help="the server's certificate")
    parser.add_argument("--fingerprint", help="SHA-256 of the server's certificate")
    parser.add_argument("--frames", type=int, default=5)
    arguments = parser.parse_args()

    token = os.environ.get("VISIONSERVER_TOKEN")
    with visionserver.connect(arguments.server, ca_file=arguments.ca,
                              fingerprint=arguments.fingerprint, token=token) as client:
        client.call("SequenceService", "StartSequence", id=arguments.stream.split("/")[0])
        for frame in itertools.islice(client.depth(arguments.stream), arguments.frames):
            depth_m = frame.depth_m(frame.width // 2, frame.height // 2)
            middle = "unknown" if depth_m is None else f"{depth_m:.4f} m"
            print(f"frame {frame.frame_number}: {frame.width} x {frame.height}, "
                  f"{100 * frame.valid_share():.1f} % valid, middle {middle}, "
                  f"{frame.dropped} dropped")


if __name__ == "__main__":
    try:
        main()
    except grpc.RpcError as error:
        sys.exit(f"{error.code().name}: {error.details()}")
    except (OSError, visionserver.CertificateError) as error:
        sys.exit(str(error))
