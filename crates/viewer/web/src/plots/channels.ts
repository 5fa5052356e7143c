/** The channels that can be plotted: their names, and the search among them. */

import { type ChannelGroup, type Subject, nameOf } from '../protocol/types';

export interface Channel {
  subject: number;
  subjectName: string;
  /** `section/entry/axis`, as the server knows it. */
  name: string;
  section: string;
  entry: string;
  axis: string;
  unit: string;
}

/** Tells a channel from all others, also in an address: "0:position/Pelvis/z". */
export function channelKey(channel: Pick<Channel, 'subject' | 'name'>): string {
  return `${channel.subject}:${channel.name}`;
}

/** The channel with this key, or undefined when nobody has it. */
export function findChannel(subjects: Subject[], key: string): Channel | undefined {
  const [id, name] = [key.slice(0, key.indexOf(':')), key.slice(key.indexOf(':') + 1)];
  const subject = subjects.find((each) => String(each.id) === id);
  if (!subject) return undefined;
  for (const channel of channelsOf(subject)) if (channel.name === name) return channel;
  return undefined;
}

/** The first channels, in the order of subjects and groups, in which each word of the text is found. */
export function search(subjects: Subject[], text: string, limit: number): Channel[] {
  const words = text.toLowerCase().split(/\s+/).filter(Boolean);
  const found: Channel[] = [];
  for (const subject of subjects) {
    for (const channel of channelsOf(subject)) {
      const where = wordsOf(channel);
      if (words.every((word) => where.includes(word))) found.push(channel);
      if (found.length >= limit) return found;
    }
  }
  return found;
}

/** What most come for, of the first subjects that have it: what is offered before anything is typed. */
export function suggestions(subjects: Subject[]): Channel[] {
  const wanted = SUGGESTED.map((name) => `/${name}/`);
  const found: Channel[] = [];
  for (const subject of subjects.slice(0, 4)) {
    for (const channel of channelsOf(subject)) {
      if (wanted.some((name) => `/${channel.name}/`.includes(name))) found.push(channel);
    }
  }
  return found;
}

/** What an axis is of this channel: of joint angles the names of the field. */
export function axisName(channel: Pick<Channel, 'section' | 'axis'>): string {
  return channel.section.includes('angles') ? (ANGLES[channel.axis] ?? channel.axis) : channel.axis;
}

/** "jRightKnee flexion", "Pelvis position z". */
export function title(channel: Channel): string {
  const section = sectionName(channel.section);
  if (channel.entry === 'CoM') return `${section.charAt(0).toUpperCase()}${section.slice(1)} ${channel.axis}`;
  if (channel.section === 'joint_angles') return `${channel.entry} ${axisName(channel)}`;
  return `${channel.entry} ${section} ${axisName(channel)}`;
}

/** "m/s²", "°". */
export function unitName(unit: string): string {
  return unit === 'deg' ? '°' : unit.replace('deg', '°').replace('s2', 's²');
}

/** Everything that a channel may be called: as on the page, as the server knows it, with its words apart. */
function wordsOf(channel: Channel): string {
  const apart = channel.entry.replaceAll(/([a-z])([A-Z])/g, '$1 $2');
  const spaced = channel.name.replaceAll('_', ' ');
  const { subjectName, name, unit } = channel;
  const all = [subjectName, title(channel), name, spaced, apart, axisName(channel), unit, unitName(unit)];
  return all.join(' ').toLowerCase();
}

function sectionName(section: string): string {
  return section.replace('center_of_mass', 'centre_of_mass').replaceAll('_', ' ');
}

function* channelsOf(subject: Subject): Generator<Channel> {
  for (const group of subject.channels) {
    for (const entry of group.entries) {
      for (const axis of group.axes) yield channel(subject, group, entry, axis);
    }
  }
}

function channel(subject: Subject, group: ChannelGroup, entry: string, axis: string): Channel {
  const { section, unit } = group;
  const name = `${section}/${entry}/${axis}`;
  return { subject: subject.id, subjectName: nameOf(subject), name, section, entry, axis, unit };
}

const ANGLES: Record<string, string> = { x: 'abduction', y: 'rotation', z: 'flexion' };

const SUGGESTED = [
  'joint_angles/jRightKnee/z',
  'joint_angles/jLeftKnee/z',
  'joint_angles/jRightHip/z',
  'joint_angles/jLeftHip/z',
  'joint_angles/jRightAnkle/z',
  'position/Pelvis/z',
  'velocity/RightFoot/x',
  'acceleration/RightFoot/z',
  'center_of_mass/CoM/z',
];
