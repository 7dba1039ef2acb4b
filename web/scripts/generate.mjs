// Makes src/gen from ../proto by Debian's protoc and protobuf-es; does nothing when that is newer
// than all its inputs, so that several scripts may run beside each other after a build.
import { execFileSync } from 'node:child_process';
import { mkdirSync, readdirSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const web = join(dirname(fileURLToPath(import.meta.url)), '..');
const protoRoot = join(web, '..', 'proto');
const out = join(web, 'src', 'gen');
const stamp = join(out, '.made');
const protos = readdirSync(join(protoRoot, 'visionserver', 'v1'))
  .filter((name) => name.endsWith('.proto'))
  .map((name) => `visionserver/v1/${name}`);

const modified = (file) => statSync(file, { throwIfNoEntry: false })?.mtimeMs ?? 0;
const inputs = [
  ...protos.map((name) => join(protoRoot, name)),
  join(protoRoot, 'visionserver', 'v1'), // a file that came or went
  join(web, 'package-lock.json'),
];
if (modified(stamp) <= Math.max(...inputs.map(modified))) {
  rmSync(out, { recursive: true, force: true });
  mkdirSync(out, { recursive: true });
  const plugin = join(web, 'node_modules', '.bin', 'protoc-gen-es');
  execFileSync(
    process.env.PROTOC ?? 'protoc',
    [`-I${protoRoot}`, `--plugin=protoc-gen-es=${plugin}`, `--es_out=${out}`,
      '--es_opt=target=ts', ...protos],
    { stdio: 'inherit' },
  );
  writeFileSync(stamp, '');
}
