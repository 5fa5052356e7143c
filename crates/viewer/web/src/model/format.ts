/** Numbers as text, in the widths that a column of them needs. */

/** "240 Hz", "59.9 Hz". */
export function hertz(rate: number): string {
  return `${shortRate(rate)} Hz`;
}

/** "240", "59.9". */
export function shortRate(rate: number): string {
  const rounded = Math.round(rate);
  return rate >= 99.5 || Math.abs(rate - rounded) < 0.05 ? String(rounded) : rate.toFixed(1);
}

/** "1,234". */
export function count(value: number): string {
  return Math.round(value).toLocaleString('en');
}

/** "3.4 ms", "120 ms"; a dash when unknown. */
export function milliseconds(value: number | null | undefined): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  return `${value < 10 ? value.toFixed(1) : Math.round(value)} ms`;
}

/** "1.2 MB". */
export function bytes(value: number): string {
  const units = ['B', 'kB', 'MB', 'GB', 'TB'];
  let place = 0;
  while (value >= 1000 && place < units.length - 1) {
    value /= 1000;
    place++;
  }
  return `${place === 0 || value >= 100 ? Math.round(value) : value.toFixed(1)} ${units[place]}`;
}

/** Seconds as "0:12.345", "1:02:03.004" from an hour on. */
export function clock(seconds: number, digits = 3): string {
  const scale = 10 ** digits;
  const whole = Math.max(Math.round(seconds * scale), 0);
  const fraction = digits > 0 ? `.${String(whole % scale).padStart(digits, '0')}` : '';
  const all = Math.floor(whole / scale);
  const [hours, minutes, rest] = [Math.floor(all / 3600), Math.floor(all / 60) % 60, all % 60];
  const tail = `${String(rest).padStart(2, '0')}${fraction}`;
  return hours > 0 ? `${hours}:${String(minutes).padStart(2, '0')}:${tail}` : `${minutes}:${tail}`;
}

/** Seconds of the day as "10:11:12.34"; the day begins again after 24 hours. */
export function timeOfDay(seconds: number, digits = 2): string {
  const scale = 10 ** digits;
  const whole = Math.round(seconds * scale) % (86_400 * scale);
  const [all, fraction] = [Math.floor(whole / scale), whole % scale];
  const parts = [Math.floor(all / 3600), Math.floor(all / 60) % 60, all % 60];
  return `${parts.map((part) => String(part).padStart(2, '0')).join(':')}.${String(fraction).padStart(digits, '0')}`;
}

/** "10:11:12.345" as seconds of the day, or null when it is none. */
export function secondsOfDay(text: string): number | null {
  const found = /^(\d{1,2}):(\d{2}):(\d{2}(?:\.\d+)?)$/.exec(text);
  return found ? Number(found[1]) * 3600 + Number(found[2]) * 60 + Number(found[3]) : null;
}
