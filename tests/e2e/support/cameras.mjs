// Two simulated GigE Vision cameras, which speak the real protocol on the network: gevsim. Only for
// tests with a network of their own.
import { spawn } from 'node:child_process';

import { program } from './tools.mjs';

const binned = 'BinningHorizontal=2&BinningVertical=2&TriggerSelector=FrameStart&TriggerMode=On&TriggerSource=Line1';
export const leftUri = `gev-ip:127.0.0.1?${binned}`;
export const rightUri = `gev-ip:127.0.0.2?${binned}`;

/** What the cameras see, as a stream; no matching, which is not what this is about. */
export const pairSequence = {
  description: 'What the two cameras see.',
  max_frames_in_flight: 2,
  priority: 0,
  blocks: [
    { id: 'cameras', type: 'StereoCamera', params: { left: leftUri, right: rightUri }, x: 0, y: 0 },
    { id: 'publish', type: 'Publish', params: { stream: 'pair' }, x: 240, y: 0 },
  ],
  connections: [{ from: 'cameras.pair', to: 'publish.value' }],
};

export class Cameras {
  #process;
  #exited;

  /** Powered and connected; `options` as of `gevsim --help`. */
  async plugIn(...options) {
    this.#process = spawn('setpriv', ['--pdeathsig', 'KILL', program('gevsim'), ...options]);
    this.#exited = new Promise((done) => this.#process.once('exit', done));
    process.once('exit', () => this.#process.kill('SIGKILL'));
    let said = '';
    this.#process.stderr.on('data', (text) => (said += text));
    await new Promise((done, failed) => {
      this.#process.stdout.on('data', (text) => {
        said += text;
        if (said.includes('gevsim ready')) done();
      });
      this.#process.once('exit', (code) => failed(new Error(`gevsim ended with ${code}: ${said}`)));
    });
  }

  /** At once, without a word to the server, as a cable is pulled. */
  async pullCable() {
    this.#process?.kill('SIGKILL');
    await this.#exited;
  }
}
