// The server's interface for tests in Node: the same gRPC-Web as the page speaks, with the messages
// read from the descriptors that protoc wrote.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';

import { build, library } from './tools.mjs';

const { createClient } = library('@connectrpc/connect');
const { createGrpcWebTransport } = library('@connectrpc/connect-web');
const { create, createFileRegistry, fromBinary, toBinary } = library('@bufbuild/protobuf');
const { FileDescriptorSetSchema } = library('@bufbuild/protobuf/wkt');

// The server has made its certificate itself a moment ago.
process.env.NODE_TLS_REJECT_UNAUTHORIZED = '0';
process.removeAllListeners('warning');

const descriptors = readFileSync(join(build, 'tests', 'e2e', 'visionserver.desc'));
const registry = createFileRegistry(fromBinary(FileDescriptorSetSchema, descriptors));

const services = {
  audit: 'AuditService',
  parameters: 'ParameterService',
  results: 'ResultService',
  sequences: 'SequenceService',
  sessions: 'SessionService',
  streams: 'StreamService',
  system: 'SystemService',
  users: 'UserService',
};

/** A client of each service, for the page's address; calls carry the token if there is one. */
export function connect(address, token = '') {
  const withToken = (next) => (request) => {
    if (token) request.header.set('authorization', `Bearer ${token}`);
    return next(request);
  };
  const transport = createGrpcWebTransport({ baseUrl: address, interceptors: [withToken] });
  return Object.fromEntries(
    Object.entries(services).map(([name, service]) => [
      name,
      createClient(registry.getService(`visionserver.v1.${service}`), transport),
    ]),
  );
}

/** The message in the body of a call that a page has made. */
export function readRequest(type, body) {
  // Behind the flags and the length that gRPC-Web puts before each message.
  return fromBinary(registry.getMessage(`visionserver.v1.${type}`), body.subarray(5));
}

/** Value of a parameter or argument: whole numbers are integers unless `double`. */
export const value = {
  int: (number) => ({ kind: { case: 'intValue', value: BigInt(number) } }),
  double: (number) => ({ kind: { case: 'doubleValue', value: number } }),
  text: (text) => ({ kind: { case: 'stringValue', value: text } }),
};

/** The bytes of a request of "Service/Method". */
export function requestBytes(method, request) {
  const [service, name] = method.split('/');
  const { input } = registry
    .getService(`visionserver.v1.${service}`)
    .methods.find((one) => one.name === name);
  return toBinary(input, create(input, request));
}
