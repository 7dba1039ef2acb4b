"""A VisionServer for Python programs: log in, call any method, iterate over depth images.

    import visionserver
    client = visionserver.connect("cell-7", fingerprint="AB:CD:...")
    client.login("operator", password)
    client.call("SequenceService", "StartSequence", id="stereo_depth")
    for frame in client.depth("stereo_depth/depth"):
        print(frame.depth_m(320, 240))

Needs python3-grpcio and python3-protobuf; pixels are numpy arrays where numpy is installed, else
arrays of the standard library. A failed call raises grpc.RpcError: `error.code()`,
`error.details()`.
"""

import array
import hashlib
import importlib
import ipaddress
import logging
import random
import socket
import ssl
import sys
import time

import grpc
from google.protobuf import symbol_database

from visionserver import rvl
from visionserver.v1 import stream_pb2

try:
    import numpy
except ImportError:
    numpy = None

DEFAULT_PORT = 50051
_OPTIONS = [
    ("grpc.max_receive_message_length", 64 << 20),
    ("grpc.keepalive_time_ms", 10_000),
    ("grpc.keepalive_timeout_ms", 5_000),
    ("grpc.max_reconnect_backoff_ms", 5_000),
    ("grpc.enable_http_proxy", 0),
]
_LOG = logging.getLogger("visionserver")
# After these the same request may succeed later, without anybody doing anything about it.
_PASSING = frozenset({
    grpc.StatusCode.UNAVAILABLE,
    grpc.StatusCode.CANCELLED,  # the server's word to a client that does not read
    grpc.StatusCode.ABORTED,
    grpc.StatusCode.INTERNAL,
    grpc.StatusCode.UNKNOWN,
    grpc.StatusCode.RESOURCE_EXHAUSTED,
    grpc.StatusCode.DEADLINE_EXCEEDED,
})
_FIRST_PAUSE_S = 0.2
_LONGEST_PAUSE_S = 5


class CertificateError(Exception):
    """The server does not show the certificate that was expected."""


def connect(address, ca_file=None, fingerprint=None, token=None, plaintext=False, timeout_s=15):
    """A client of the server at HOST, HOST:PORT or [IPV6]:PORT.

    The server is known by `ca_file` (its certificate, or the authority that signed it) or by
    `fingerprint`, the SHA-256 that it prints when it starts. `plaintext` is for a server on this
    machine that was started without TLS. `token` is an API key or the token of an earlier login.
    """
    host, port = _split(address)
    target = f"[{host}]:{port}" if ":" in host else f"{host}:{port}"
    if plaintext:
        if not _is_loopback(host):
            raise ValueError(f"plain text to {host} would show passwords to the network; use TLS")
        return Client(grpc.insecure_channel(target, _OPTIONS), token, timeout_s)
    options = list(_OPTIONS)
    if fingerprint:
        roots, name = _pinned(host, port, fingerprint)
        if name:
            options.append(("grpc.ssl_target_name_override", name))
    elif ca_file:
        with open(ca_file, "rb") as file:
            roots = file.read()
    else:
        roots = None
    credentials = grpc.ssl_channel_credentials(root_certificates=roots)
    return Client(grpc.secure_channel(target, credentials, options), token, timeout_s)


class Client:
    """A connection to a server; make it with `connect`. Usable in a `with` statement."""

    def __init__(self, channel, token, timeout_s):
        self._channel = channel
        self._token = token
        self._timeout_s = timeout_s

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self._channel.close()

    def login(self, user, password):
        """Logs in; all later calls carry the token. Returns the LoginResponse: a program with a
        one-time password sees `must_change_password` and calls ChangePassword first."""
        response = self.call("SessionService", "Login", user=user, password=password,
                             client="Python client")
        self._token = response.token
        return response

    def call(self, service, method, **fields):
        """Any method that answers once; `fields` are those of its request. Returns its response."""
        path, request_class, response_class = _method(service, method)
        call = self._channel.unary_unary(path, request_class.SerializeToString,
                                         response_class.FromString)
        return call(request_class(**fields), timeout=self._timeout_s, metadata=self._metadata())

    def watch(self, service, method, **fields):
        """Any method that answers with a stream: an iterator over its messages, with cancel()."""
        path, request_class, response_class = _method(service, method)
        call = self._channel.unary_stream(path, request_class.SerializeToString,
                                          response_class.FromString)
        return call(request_class(**fields), metadata=self._metadata())

    def depth(self, stream, window=2, max_fps=0, codec=stream_pb2.CODEC_RAW):
        """Depth images of a stream such as "stereo_depth/depth", as they come, until broken off.

        The server sends the next image when the previous one was dealt with, so a slow loop skips
        images rather than fall behind. CODEC_RAW suits a local network; CODEC_RVL is a fifth of
        the size but slow to unpack in Python.

        A stream that once stood is opened again when it is lost: the server was restarted, or the
        loop took longer over one image than the server waits (30 s). An error that waiting does not
        mend, such as UNAUTHENTICATED, is raised, and so is any failure to open the first time.
        """
        subscription = stream_pb2.Subscription(id=1, stream=stream, codec=codec, window=window,
                                               max_fps=max_fps)
        stood = False
        attempts = 0
        while True:
            ending = "the server ended it"
            try:
                for frame in self._subscribed(subscription):
                    stood = True
                    attempts = 0
                    if frame is not None:
                        yield frame
            except grpc.RpcError as error:
                if not stood or error.code() not in _PASSING:
                    raise
                ending = error.details()
            _LOG.warning("stream %s: %s; trying again", stream, ending)
            longest_s = min(_LONGEST_PAUSE_S, _FIRST_PAUSE_S * 2 ** min(attempts, 8))
            time.sleep(random.uniform(longest_s / 2, longest_s))
            attempts += 1

    def _subscribed(self, subscription):
        """The images of one Subscribe to its end, with None for what else it says."""
        items = self.watch("StreamService", "Subscribe", subscriptions=[subscription])
        stream_id = None
        try:
            for item in items:
                if item.stream_id:
                    stream_id = item.stream_id
                if item.subscription_id != subscription.id or item.notice:
                    yield None
                    continue
                yield DepthFrame(item)
                self._acknowledge(stream_id, subscription.id, item.seq)
        finally:
            items.cancel()

    def _acknowledge(self, stream_id, subscription_id, seq):
        item = stream_pb2.Acknowledgement(subscription_id=subscription_id, seq=seq)
        try:
            self.call("StreamService", "Ack", stream_id=stream_id, items=[item])
        except grpc.RpcError:
            pass  # the stream itself tells what is wrong

    def _metadata(self):
        return [("authorization", f"Bearer {self._token}")] if self._token else []


class DepthFrame:
    """One depth image. `values[y][x]` is a stored number; 0 means that nothing is known there."""

    def __init__(self, item):
        header = item.header
        self.width = header.width
        self.height = header.height
        self.geometry = header.geometry
        self.seq = item.seq
        self.dropped = item.dropped
        self.frame_number = header.frame_number
        self.capture_time = header.capture_time.ToDatetime()
        self.is_disparity = header.kind == stream_pb2.STREAM_KIND_DISPARITY
        self.scale = header.value_scale
        self.offset = header.value_offset
        if not self.is_disparity and (header.kind != stream_pb2.STREAM_KIND_DEPTH
                                      or header.codec == stream_pb2.CODEC_RAW):
            raise ValueError("the stream holds no disparity; a depth stream needs CODEC_RVL")
        self.values = _rows(item.payload, header)

    def depth_m(self, x, y):
        """Metres along the optical axis at a pixel; None where nothing is known."""
        stored = int(self.values[y][x])
        if stored == 0:
            return None
        value = stored * self.scale + self.offset
        if not self.is_disparity:
            return value
        geometry = self.geometry
        disparity_px = value + geometry.principal_offset_px
        if geometry.focal_px <= 0 or disparity_px <= 0:
            return None
        return geometry.focal_px * geometry.baseline_m / disparity_px

    def point_m(self, x, y):
        """(x, y, z) in the left camera's frame, metres; None where nothing is known."""
        depth_m = self.depth_m(x, y)
        geometry = self.geometry
        if depth_m is None or geometry.focal_px <= 0:
            return None
        return ((x - geometry.cx_px) * depth_m / geometry.focal_px,
                (y - geometry.cy_px) * depth_m / geometry.focal_px, depth_m)

    def valid_share(self):
        """Share of pixels that are known, 0..1."""
        if numpy is not None:
            return numpy.count_nonzero(self.values) / (self.width * self.height)
        invalid = sum(row.tolist().count(0) for row in self.values)
        return 1 - invalid / (self.width * self.height)


def _rows(payload, header):
    pixels = header.width * header.height
    if header.codec == stream_pb2.CODEC_RVL:
        values = rvl.decode(payload, pixels)
    elif header.codec == stream_pb2.CODEC_RAW and len(payload) == 2 * pixels:
        values = array.array("H", payload)
        if sys.byteorder == "big":
            values.byteswap()
    else:
        raise ValueError("a depth image does not fit its header")
    if numpy is not None:
        return numpy.frombuffer(values, dtype=numpy.uint16).reshape(header.height, header.width)
    whole = memoryview(values)
    return [whole[y * header.width:(y + 1) * header.width] for y in range(header.height)]


def _method(service, method):
    """Path, request class and response class of a method, found in the generated code."""
    name = service.removesuffix("Service").lower()
    module = importlib.import_module(f"visionserver.v1.{name}_pb2")
    descriptor = module.DESCRIPTOR.services_by_name[service].methods_by_name[method]
    path = f"/{descriptor.containing_service.full_name}/{method}"
    classes = symbol_database.Default()
    return (path, classes.GetSymbol(descriptor.input_type.full_name),
            classes.GetSymbol(descriptor.output_type.full_name))


def _split(address):
    if address.startswith("["):
        host, _, port = address[1:].partition("]")
        return host, int(port[1:] or DEFAULT_PORT)
    host, _, port = address.partition(":")
    return host, int(port or DEFAULT_PORT)


def _is_loopback(host):
    try:
        return host == "localhost" or ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def _pinned(host, port, fingerprint):
    """The certificate that the server shows, if it has this fingerprint, and a name that it is for."""
    pem = ssl.get_server_certificate((host, port))
    shown = hashlib.sha256(ssl.PEM_cert_to_DER_cert(pem)).hexdigest().upper()
    expected = fingerprint.replace(":", "").upper()
    if shown != expected:
        raise CertificateError(
            f"the certificate of {host}:{port} has the fingerprint {shown}, expected was "
            f"{expected}; take over the new one only if the server itself printed it")
    # This very certificate is the root from here on, so any name that it carries will do.
    context = ssl.create_default_context(cadata=pem)
    context.check_hostname = False
    context.verify_flags |= ssl.VERIFY_X509_PARTIAL_CHAIN
    with socket.create_connection((host, port), timeout=5) as plain:
        with context.wrap_socket(plain) as secure:
            names = secure.getpeercert().get("subjectAltName", ())
    return pem.encode(), names[0][1] if names else None
