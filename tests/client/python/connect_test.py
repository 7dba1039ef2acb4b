"""Run by python_client_test.cc against a server of its own: trust, login, calls and errors."""

import os
import unittest

import grpc

import visionserver
from visionserver.v1 import session_pb2

ADDRESS = os.environ["TEST_ADDRESS"]
FINGERPRINT = os.environ["TEST_FINGERPRINT"]
CA_FILE = os.environ["TEST_CA_FILE"]
API_KEY = os.environ["TEST_API_KEY"]
PASSWORD = os.environ["TEST_PASSWORD"]


class Connect(unittest.TestCase):
    def test_a_fingerprint_makes_the_server_known(self):
        with visionserver.connect(ADDRESS, fingerprint=FINGERPRINT) as client:
            self.assertEqual("VisionServer", client.call("SystemService", "GetServerInfo").product)

    def test_a_certificate_file_makes_the_server_known(self):
        with visionserver.connect(ADDRESS, ca_file=CA_FILE) as client:
            self.assertEqual("VisionServer", client.call("SystemService", "GetServerInfo").product)

    def test_another_fingerprint_is_refused_before_anything_is_sent(self):
        with self.assertRaises(visionserver.CertificateError) as caught:
            visionserver.connect(ADDRESS, fingerprint="AB:" * 31 + "AB")
        self.assertIn(FINGERPRINT.replace(":", ""), str(caught.exception))

    def test_an_unknown_certificate_is_refused(self):
        with visionserver.connect(ADDRESS, timeout_s=5) as client:
            with self.assertRaises(grpc.RpcError) as caught:
                client.call("SystemService", "GetServerInfo")
        self.assertEqual(grpc.StatusCode.UNAVAILABLE, caught.exception.code())

    def test_plain_text_stays_on_this_machine(self):
        with self.assertRaises(ValueError):
            visionserver.connect("192.0.2.1", plaintext=True)


class Calls(unittest.TestCase):
    def setUp(self):
        self.client = visionserver.connect(ADDRESS, fingerprint=FINGERPRINT)
        self.addCleanup(self.client.close)

    def code_of(self, *arguments, **fields):
        with self.assertRaises(grpc.RpcError) as caught:
            self.client.call(*arguments, **fields)
        return caught.exception.code()

    def test_a_login_opens_what_its_role_may(self):
        self.assertEqual(grpc.StatusCode.UNAUTHENTICATED, self.code_of("SessionService", "WhoAmI"))
        self.assertEqual(session_pb2.ROLE_VIEWER, self.client.login("ana", PASSWORD).role)
        self.assertEqual("ana", self.client.call("SessionService", "WhoAmI").user)
        self.assertEqual(grpc.StatusCode.PERMISSION_DENIED, self.code_of("UserService", "ListUsers"))

    def test_a_wrong_password_is_refused(self):
        with self.assertRaises(grpc.RpcError) as caught:
            self.client.login("ana", "wrong password")
        self.assertEqual(grpc.StatusCode.UNAUTHENTICATED, caught.exception.code())

    def test_an_api_key_needs_no_login(self):
        with visionserver.connect(ADDRESS, fingerprint=FINGERPRINT, token=API_KEY) as robot:
            self.assertEqual(session_pb2.ROLE_ROBOT, robot.call("SessionService", "WhoAmI").role)


if __name__ == "__main__":
    unittest.main()
