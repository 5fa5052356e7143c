/**
 * What the server tells of subjects, and what one sample of a subject holds.
 *
 * Everything is canonical: metres, seconds, X forward, Y left, Z up, quaternions w, x, y, z, every orientation the
 * identity in the T-pose. NaN is "not tracked" or "not sent", never a zero.
 */

/** Three coordinates in metres: X forward, Y left, Z up. */
export type Vector = [number, number, number];

/** What a subject is. */
export type SubjectKind = 'person' | 'rigid body' | 'skeleton' | 'markers';

/** What a segment is. */
export type SegmentKind = 'body' | 'prop' | 'left finger' | 'right finger';

/** A point fixed to a segment, by its offset from the segment's origin in the segment's axes. */
export interface Point {
  name: string;
  offset: Vector;
}

/** A rigid part of a subject. */
export interface Segment {
  name: string;
  kind: SegmentKind;
  /** The place of the segment it hangs on. */
  parent: number | null;
  /** Its origin in the null pose (a T-pose); null when the sender did not say. */
  origin: Vector | null;
  points: Point[];
}

/** Where two segments meet. */
export interface Joint {
  name: string;
  /** The places of both segments. */
  parent: number;
  child: number;
  /** The joint from the parent's origin, in the parent's axes. */
  offset_parent: Vector | null;
}

/** Channels that can be plotted: each entry has each axis; the name of one is `section/entry/axis`. */
export interface ChannelGroup {
  section: string;
  entries: string[];
  axes: string[];
  unit: string;
}

/** One performer, tracked object or set of markers. */
export interface Subject {
  /** The viewer's own number, the same while the server runs. */
  id: number;
  /** The place of its source in `Scene.source`. */
  source: number;
  name: string;
  /** Six hexadecimal digits without `#`, or null when it sends none. */
  color: string | null;
  rate_hz: number | null;
  kind: SubjectKind;
  segments: Segment[];
  joints: Joint[];
  /** What the bits of `SubjectRecord.contacts` are, from the lowest. */
  contacts: string[];
  channels: ChannelGroup[];
}

/** What it is called on the page, also before or without a name of its own. */
export function nameOf(subject: Subject): string {
  const { name, kind, id } = subject;
  return name || `${kind.charAt(0).toUpperCase()}${kind.slice(1)} ${id + 1}`;
}

/** A marker of a take's timeline. */
export interface TakeMarker {
  frame: number;
  name: string;
}

/** One subject's recording; takes share one timeline by `start_s`. */
export interface Take {
  id: number;
  subject: number;
  file: string;
  rate_hz: number;
  frames: number;
  first_sample: number;
  start_s: number;
  duration_s: number;
  /** The frame before each gap, and how many samples are missing there. */
  gaps: [number, number][];
  /** The first of each stretch of frames whose pose was lost, which show another's, and how many they are. */
  lost_poses?: [number, number][];
  markers: TakeMarker[];
  start_timecode: string | null;
}

/** The whole description, from `GET /api/scene` and the `scene` message. */
export interface Scene {
  posewire: string;
  mode: 'live' | 'takes';
  recorder: boolean;
  source: string[];
  subjects: Subject[];
  takes: Take[];
}

/**
 * What the server thinks of a subject: samples come, came a moment ago, came long ago. Away is whose take has not begun or
 * is over.
 */
export const State = { Live: 0, Stale: 1, Lost: 2, Away: 3 } as const;
export type State = (typeof State)[keyof typeof State];

/** The bits of `SubjectRecord.flags`. */
export const Flag = {
  /** Positions were sent. */
  Positions: 1,
  /** Orientations were sent. */
  Orientations: 2,
  /** Positions are the server's, from orientations, the root in place (type 22 alone). */
  InPlace: 4,
  /** The centre of mass is the server's estimate. */
  EstimatedCenterOfMass: 8,
  /** Contacts are known. */
  Contacts: 16,
} as const;

/** The newest sample of one subject. */
export interface SubjectRecord {
  id: number;
  sample: number;
  /** One bit for each of `Subject.contacts`. */
  contacts: number;
  /** The source's clock in seconds. */
  time: number;
  /** Seconds since it arrived; 0 in takes. */
  age: number;
  /** The timecode as seconds of the day, or NaN. */
  timecode: number;
  state: State;
  /** The bits of `Flag`. */
  flags: number;
  /** Per segment x, y, z: NaN where not tracked, NaN throughout where not sent. */
  position: Float32Array;
  /** Per segment w, x, y, z. */
  orientation: Float32Array;
  /** x, y, z, NaN where unknown. */
  centerOfMass: Float32Array;
  /** Per marker x, y, z. */
  markers: Float32Array;
}
