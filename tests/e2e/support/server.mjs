// A real server with a data folder of its own, on free ports. It dies with the test, whatever happens.
import { spawn } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import { connect } from './api.mjs';
import { program } from './tools.mjs';

export const adminPassword = 'a long enough secret';

const clockTicksPerSecond = 100; // Linux, on all processors that there are builds for

export class TestServer {
  #folder = mkdtempSync(join(tmpdir(), 'vs-e2e-'));
  #process;
  #greeting = '';
  #errors = '';
  #exited;
  /** Where the page is, without the slash at its end. */
  page = '';
  oneTimePassword = '';
  /** Token and clients of the administrator; only after `setUp`. */
  token = '';
  admin;

  /** `sequences` by id, as they are stored; they start with the server. */
  constructor(sequences = {}) {
    for (const folder of ['sequences', 'data']) mkdirSync(join(this.#folder, folder), { mode: 0o700 });
    for (const [id, spec] of Object.entries(sequences)) this.store(id, spec);
  }

  /** A sequence that starts with the server. */
  store(id, spec) {
    const stored = { autostart: true, sequence: { id, ...spec } };
    writeFileSync(join(this.#folder, 'sequences', `${id}.json`), JSON.stringify(stored));
  }

  /** For what sequences read; given to the server as a picture root. */
  get pictures() {
    return join(this.#folder, 'data');
  }

  get pid() {
    return this.#process.pid;
  }

  /** The second time on the ports of the first. */
  async start() {
    const [grpc, web] = this.#ports ?? [0, 0];
    writeFileSync(
      join(this.#folder, 'server.conf'),
      `data_dir: "store"
       listen_address: "127.0.0.1:${grpc}"
       web_address: "127.0.0.1:${web}"
       sequences_dir: "${this.#folder}/sequences"
       picture_root: "${this.pictures}"
       limits { streams_per_session: 1000 }`,
    );
    // The parent may be killed without a chance to clean up.
    const command = ['--pdeathsig', 'KILL', program('visionserver'), '--config'];
    this.#process = spawn('setpriv', [...command, join(this.#folder, 'server.conf')]);
    this.#exited = new Promise((done) => this.#process.once('exit', done));
    process.once('exit', () => this.#process.kill('SIGKILL'));
    this.#greeting = '';
    this.#process.stderr.on('data', (text) => (this.#errors += text));
    await this.#greeted();
    this.page = this.#greeting.match(/the page is at (\S+?)\/?\s/)[1];
    this.oneTimePassword ||= this.#greeting.match(/one-time password .*: (\S+)/)?.[1] ?? '';
    this.#ports = [this.#greeting.match(/listens on \S+:(\d+)/)[1], new URL(this.page).port];
    return this;
  }
  #ports;

  #greeted() {
    return new Promise((done, failed) => {
      this.#process.stdout.on('data', (text) => {
        this.#greeting += text;
        const last = this.oneTimePassword || this.#ports ? 'fingerprint' : 'one-time password';
        if (this.#greeting.includes(last) && this.#greeting.endsWith('\n')) done();
      });
      this.#process.once('error', failed);
      this.#process.once('exit', (code) =>
        failed(new Error(`the server ended with ${code}: ${this.#greeting} ${this.#errors}`)),
      );
    });
  }

  /** Makes the administrator's password `adminPassword`, and others: { name: role number }. */
  async setUp(users = {}) {
    const anybody = connect(this.page);
    const first = await anybody.sessions.login({ user: 'admin', password: this.oneTimePassword });
    await connect(this.page, first.token).sessions.changePassword({
      oldPassword: this.oneTimePassword,
      newPassword: adminPassword,
    });
    this.token = first.token;
    this.admin = connect(this.page, first.token);
    for (const [name, role] of Object.entries(users)) {
      const { oneTimePassword } = await this.admin.users.createUser({ name, role });
      const { token } = await anybody.sessions.login({ user: name, password: oneTimePassword });
      await connect(this.page, token).sessions.changePassword({
        oldPassword: oneTimePassword,
        newPassword: passwordOf(name),
      });
    }
    return this;
  }

  /** Processor time that it has used so far, seconds. */
  cpuSeconds() {
    const fields = readFileSync(`/proc/${this.pid}/stat`, 'utf8').split(') ')[1].split(' ');
    return (Number(fields[11]) + Number(fields[12])) / clockTicksPerSecond;
  }

  /** As a machine does that loses its power. */
  async kill() {
    this.#process.kill('SIGKILL');
    await this.#exited;
  }

  /** Ends it and removes what it stored. */
  async end() {
    await this.kill();
    rmSync(this.#folder, { recursive: true, force: true });
  }
}

export const passwordOf = (user) => `secret of ${user}`;
export const role = { viewer: 1, operator: 2, engineer: 3, admin: 4, robot: 5 };
