// Takes that the program writes of its walker, and the same numbers as read from their text.

import { readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { run } from './program.mjs';

/** An MVNX file of a walker at 60 Hz. The samples of `missing`, pairs of the first and the one behind the last, are cut out. */
export async function walkerTake(context, folder, name, seconds, missing = []) {
  const file = path.join(folder, name);
  await run(context, 'convert', 'synthetic:walk?rate=60', file, '--duration', String(seconds));
  const cut = (sample) => missing.some(([from, to]) => sample >= from && sample < to);
  const text = readFileSync(file, 'utf8').replace(FRAME, (frame, sample) => (cut(Number(sample)) ? '' : frame));
  writeFileSync(file, text);
  return { file, frames: framesOf(text), joints: labels(text, 'joint'), segments: labels(text, 'segment') };
}

/** The normal frames: their sample and the numbers of their sections. */
function framesOf(text) {
  return [...text.matchAll(FRAME)].map(([frame, sample]) => ({
    sample: Number(sample),
    position: numbers(frame, 'position'),
    jointAngle: numbers(frame, 'jointAngle'),
  }));
}

function numbers(frame, section) {
  return new RegExp(`<${section}>([^<]*)`).exec(frame)[1].trim().split(/\s+/).map(Number);
}

function labels(text, element) {
  return [...text.matchAll(new RegExp(`<${element} label="([^"]*)"`, 'g'))].map(([, label]) => label);
}

const FRAME = /\s*<frame [^>]*index="(\d+)"[^>]*type="normal"[\s\S]*?<\/frame>/g;
