// To be imported first, by a test with GigE Vision cameras: their control port is fixed, so that two
// tests on one network would meet. The test runs itself again in a network namespace of its own, where
// there is only a loopback interface; for root and, by a user namespace, for others.
import { spawnSync } from 'node:child_process';

const inside = 'VS_TEST_OWN_NETWORK';

if (!process.env[inside]) {
  const enter = ['unshare', process.getuid() === 0 ? '-n' : '-Urn', '--', 'sh', '-c', 'ip link set lo up && exec "$@"', 'sh'];
  const [command, ...args] = enter;
  const probed = spawnSync(command, [...args, 'true'], { encoding: 'utf8' });
  if (probed.status !== 0) {
    console.log(`[  SKIPPED ] no network of its own for this test: ${probed.error ?? probed.stderr}`);
    process.exit(0);
  }
  // Nothing outlives the test, also when it is killed.
  const again = ['setpriv', '--pdeathsig', 'KILL', process.execPath, ...process.argv.slice(1)];
  const { status } = spawnSync(command, [...args, ...again], {
    stdio: 'inherit',
    env: { ...process.env, [inside]: '1' },
  });
  process.exit(status ?? 1);
}
