// The program as a child process. Every process that is started here ends with its test.

import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { readFileSync } from 'node:fs';
import { createInterface } from 'node:readline';

const BINARY = process.env.POSEWIRE;

/** Starts posewire; what it says is kept as lines, of both its outputs. */
export function start(context, ...args) {
  const child = spawn(BINARY, args, { stdio: ['ignore', 'pipe', 'pipe'] });
  const lines = [];
  for (const stream of [child.stdout, child.stderr]) {
    createInterface({ input: stream }).on('line', (line) => lines.push(line));
  }
  const program = { args, child, lines, ended: once(child, 'close') };
  context.after(() => stop(program));
  return program;
}

/** Ends a program as Ctrl-C does, and waits for it. */
export async function stop({ child, ended }) {
  if (child.exitCode === null && child.signalCode === null) child.kill('SIGINT');
  await ended;
}

/** Runs posewire to its end, which has to be a good one. */
export async function run(context, ...args) {
  const program = start(context, ...args);
  const [code] = await program.ended;
  assert.equal(code, 0, program.lines.join('\n'));
  return program.lines;
}

/** The rest of the first line that begins with these words. */
export async function said(program, words) {
  const find = () => program.lines.find((line) => line.startsWith(words));
  await until(
    () => find() !== undefined || program.child.exitCode !== null,
    `“${words}” from ${program.args.join(' ')}`,
  );
  assert.ok(find(), program.lines.join('\n'));
  return find().slice(words.length).trim();
}

/** Starts `posewire view` on ports of the system's choice. `endpoint` is where it listens for streams. */
export async function view(context, sources, ...args) {
  const program = start(context, 'view', ...sources, '--listen', '127.0.0.1:0', ...args);
  const url = await said(program, 'open ');
  const shown = program.lines.find((line) => line.startsWith('showing '));
  return { ...program, url, endpoint: shown?.slice('showing '.length) };
}

/** Starts `posewire monitor`, whose numbers the page's are held against. */
export async function monitor(context) {
  const program = start(context, 'monitor', 'mxtp://127.0.0.1:0', '--json', '--frames');
  const endpoint = await said(program, 'listening on ');
  const frames = () =>
    program.lines.filter((line) => line.startsWith('{"kind":"frame"')).map((line) => JSON.parse(line));
  return { ...program, endpoint, frames };
}

/** Bytes of memory that a process holds; null where the system does not say. */
export function memory({ child }) {
  try {
    const found = /VmRSS:\s+(\d+) kB/.exec(readFileSync(`/proc/${child.pid}/status`, 'utf8'));
    return found ? Number(found[1]) * 1024 : null;
  } catch {
    return null;
  }
}

/** Waits until something holds. */
export async function until(holds, what, seconds = 20) {
  const end = Date.now() + seconds * 1000;
  for (;;) {
    const value = await holds();
    if (value) return value;
    assert.ok(Date.now() < end, `waited ${seconds} s for ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}
