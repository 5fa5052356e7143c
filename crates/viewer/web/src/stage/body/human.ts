import { Vector3 } from 'three';
import type { Segment } from '../../protocol/types';
import type { NullPose } from './null_pose';
import { type Part, type Section, part } from './part';
import type { Limbs, Roles } from './roles';

/** The parts of a person's body and head, arms and legs, without fingers: shaped by the null pose's own lengths. */
export function human(segments: Segment[], pose: NullPose, roles: Roles): Part[] {
  const body = new Body(segments, pose, roles);
  return [
    ...torso(body),
    ...head(body),
    ...[roles.left, roles.right].flatMap((side) => [...arm(body, side), ...leg(body, side)]),
  ];
}

/** How much larger than MVN's adult of 1.75 m a person is. */
export function scale(pose: NullPose, roles: Roles): number {
  const [head, foot] = [pose[roles.head], pose[roles.left.foot]];
  const height = head && foot ? head.z - foot.z : NOMINAL_HEIGHT;
  return Math.min(Math.max(height / NOMINAL_HEIGHT, 0.3), 2.5);
}

/** The height of the head's origin above the ankle's in the nominal adult. */
const NOMINAL_HEIGHT = 1.43;

/** The null pose of one person, asked in words. */
class Body {
  readonly size: number;

  constructor(
    readonly segments: Segment[],
    readonly pose: NullPose,
    readonly roles: Roles,
  ) {
    this.size = scale(pose, roles);
  }

  /** From one segment's origin to another's, in the axes of both. */
  way(from: number, to: number): Vector3 {
    const [a, b] = [this.pose[from], this.pose[to]];
    return a && b ? b.clone().sub(a) : new Vector3();
  }

  /** A vector of the nominal adult in this person's size. */
  at(x: number, y: number, z: number): Vector3 {
    return new Vector3(x, y, z).multiplyScalar(this.size);
  }

  section(broad: number, deep: number): Section {
    return [broad * this.size, deep * this.size];
  }

  caps(start: number, end: number): [number, number] {
    return [start * this.size, end * this.size];
  }

  /** A point of a segment by how its name ends. */
  point(segment: number, name: string): Vector3 | null {
    const found = this.segments[segment]?.points.find((point) => point.name.endsWith(name));
    return found ? new Vector3(...found.offset) : null;
  }
}

function torso(body: Body): Part[] {
  const { pelvis, spine, neck } = body.roles;
  const hips = Math.abs(body.way(body.roles.right.upperLeg, body.roles.left.upperLeg).y) / 2;
  const chain = [...spine, neck];
  return [
    hip(body, pelvis, hips),
    ...spine.map((segment, place) => vertebrae(body, segment, chain[place + 1] ?? neck, place === spine.length - 1)),
    // The first of the spine starts well above the hips: the pelvis fills what is between.
    waist(body, pelvis, chain[0] ?? neck),
  ];
}

function hip(body: Body, pelvis: number, hips: number): Part {
  const joint = hips / (0.09 * body.size);
  return part(pelvis, body.at(-0.004, 0, -0.005), body.at(-0.002, 0, 0.06), {
    start: body.section(0.08 * joint + 0.074, 0.104),
    end: body.section(0.152, 0.106),
    caps: body.caps(0.09, 0.045),
    tone: 'trousers',
  });
}

function waist(body: Body, pelvis: number, next: number): Part {
  return part(pelvis, body.at(0, 0, 0.03), body.way(pelvis, next), {
    start: body.section(0.139, 0.097),
    end: body.section(0.135, 0.098),
    caps: body.caps(0.04, 0.045),
    tone: 'trousers',
  });
}

/** One piece of the spine with what is around it, as broad as a person is at its height between pelvis and neck. */
function vertebrae(body: Body, segment: number, next: number, last: boolean): Part {
  if (last) return ribs(body, segment, next);
  const { pelvis, neck } = body.roles;
  const total = Math.max(body.way(pelvis, neck).z, 1e-3);
  const low = profile(body.way(pelvis, segment).z / total);
  const high = profile(body.way(pelvis, next).z / total);
  return part(segment, body.at(0, 0, 0), body.way(segment, next), {
    start: body.section(...low),
    // A little less than where the next begins, so that the two surfaces never lie in each other.
    end: body.section(high[0] - 0.002, high[1] - 0.002),
    caps: body.caps(0.045, 0.05),
    tone: 'suit',
  });
}

function ribs(body: Body, segment: number, neck: number): Part {
  const top = body.way(segment, neck);
  return part(segment, body.at(0.004, 0, -0.016), top.clone().multiplyScalar(0.62), {
    start: body.section(0.15, 0.116),
    end: body.section(0.157, 0.094),
    caps: body.caps(0.05, 0.07),
    bulge: 0.007 * body.size,
    tone: 'suit',
  });
}

/** Half the breadth and depth of a torso at a height between hips (0) and neck (1), in metres of the nominal adult. */
function profile(height: number): Section {
  const place = Math.min(Math.max(height, 0), 0.999) * (PROFILE.length - 1);
  const [low, high] = [PROFILE[Math.floor(place)], PROFILE[Math.floor(place) + 1]];
  if (!low || !high) return [0.13, 0.1];
  const rest = place - Math.floor(place);
  return [low[0] + (high[0] - low[0]) * rest, low[1] + (high[1] - low[1]) * rest];
}

const PROFILE: Section[] = [
  [0.15, 0.104],
  [0.135, 0.098],
  [0.128, 0.095],
  [0.134, 0.101],
  [0.144, 0.11],
  [0.15, 0.104],
];

function head(body: Body): Part[] {
  const { neck, head: skull } = body.roles;
  const top = body.point(skull, 'TopOfHead')?.z ?? 0.23 * body.size;
  const size = top / 0.23;
  const at = (x: number, y: number, z: number) => new Vector3(x, y, z).multiplyScalar(size);
  return [
    part(
      neck,
      body.at(-0.008, 0, -0.05),
      body
        .way(neck, skull)
        .multiplyScalar(0.42)
        .add(body.at(-0.002, 0, 0)),
      {
        start: body.section(0.135, 0.082),
        end: body.section(0.064, 0.066),
        caps: body.caps(0.03, 0.006),
        bulge: -0.01 * body.size,
      },
    ),
    part(neck, body.at(0, 0, 0), body.way(neck, skull).add(at(0.006, 0, 0.03)), {
      start: body.section(0.058, 0.058),
      end: body.section(0.055, 0.058),
      caps: body.caps(0.02, 0.02),
      tone: 'skin',
    }),
    part(skull, at(0.02, 0, 0.03), at(0.004, 0, 0.138), {
      start: [0.054 * size, 0.08 * size],
      end: [0.076 * size, 0.095 * size],
      caps: [0.042 * size, 0.092 * size],
      bulge: 0.008 * size,
      tone: 'skin',
    }),
    // A band that comes out of the head in front alone: it says where the face is.
    part(skull, at(0.0225, 0, 0.1), at(0.0205, 0, 0.129), {
      start: [0.0712 * size, 0.09 * size],
      end: [0.072 * size, 0.0905 * size],
      caps: [0.007 * size, 0.007 * size],
      tone: 'visor',
    }),
  ];
}

function arm(body: Body, side: Limbs): Part[] {
  const upper = body.way(side.upperArm, side.foreArm);
  const fore = body.way(side.foreArm, side.hand);
  const parts = [
    part(side.upperArm, upper.clone().multiplyScalar(0.03), upper, {
      start: body.section(0.058, 0.057),
      end: body.section(0.041, 0.041),
      caps: body.caps(0.06, 0.041),
      bulge: 0.004 * body.size,
      broad: FORWARD,
    }),
    part(side.foreArm, new Vector3(), fore, {
      start: body.section(0.04, 0.039),
      end: body.section(0.028, 0.022),
      caps: body.caps(0.038, 0.02),
      bulge: 0.008 * body.size,
      broad: FORWARD,
    }),
    palm(body, side, fore),
  ];
  return side.shoulder === null ? parts : [shoulder(body, side.shoulder, side.upperArm), ...parts];
}

function shoulder(body: Body, segment: number, upperArm: number): Part {
  const way = body.way(segment, upperArm);
  return part(segment, way.clone().multiplyScalar(0.1), way.clone().multiplyScalar(0.96), {
    start: body.section(0.08, 0.056),
    end: body.section(0.06, 0.058),
    caps: body.caps(0.05, 0.056),
    broad: FORWARD,
  });
}

/** The hand without its fingers: it ends at the knuckles. */
function palm(body: Body, side: Limbs, fore: Vector3): Part {
  const out = fore.clone().normalize();
  const reach = knuckles(body, side.hand) ?? 0.088 * body.size;
  return part(side.hand, out.clone().multiplyScalar(0.018 * body.size), out.clone().multiplyScalar(reach - 0.012), {
    start: body.section(0.03, 0.02),
    end: body.section(0.041, 0.016),
    caps: body.caps(0.024, 0.02),
    broad: FORWARD,
    tone: 'skin',
  });
}

function knuckles(body: Body, hand: number): number | null {
  const first = body.point(hand, 'Pinky') ?? body.point(hand, 'BallHand');
  return first ? Math.abs(first.y) : null;
}

function leg(body: Body, side: Limbs): Part[] {
  const thigh = body.way(side.upperLeg, side.lowerLeg);
  const shin = body.way(side.lowerLeg, side.foot);
  return [
    part(side.upperLeg, thigh.clone().multiplyScalar(0.02), thigh, {
      start: body.section(0.088, 0.092),
      end: body.section(0.055, 0.057),
      caps: body.caps(0.088, 0.056),
      bulge: 0.008 * body.size,
      bow: 0.008 * body.size,
      tone: 'trousers',
    }),
    part(side.lowerLeg, new Vector3(), shin, {
      start: body.section(0.052, 0.054),
      end: body.section(0.035, 0.038),
      caps: body.caps(0.053, 0.036),
      bulge: 0.009 * body.size,
      bow: -0.014 * body.size,
      tone: 'trousers',
    }),
    ...foot(body, side),
  ];
}

function foot(body: Body, side: Limbs): Part[] {
  const ball = side.toe === null ? body.at(0.16, 0, -0.07) : body.way(side.foot, side.toe);
  const sole = ball.z - 0.02 * body.size;
  const heel = new Vector3(-0.022 * body.size, 0, sole + 0.042 * body.size);
  const parts = [
    part(side.foot, heel, new Vector3(ball.x - 0.012 * body.size, ball.y, sole + 0.032 * body.size), {
      start: body.section(0.037, 0.042),
      end: body.section(0.049, 0.032),
      caps: body.caps(0.034, 0.03),
      bulge: 0.002,
      bow: -0.012 * body.size,
      tone: 'shoe',
    }),
    // The ankle's front, which would be a notch between shin and instep.
    part(side.foot, body.at(0, 0, -0.005), new Vector3(ball.x * 0.5, 0, sole + 0.045 * body.size), {
      start: body.section(0.036, 0.038),
      end: body.section(0.036, 0.03),
      tone: 'shoe',
    }),
  ];
  if (side.toe !== null) parts.push(toe(body, side.toe));
  return parts;
}

function toe(body: Body, segment: number): Part {
  const tip = body.point(segment, 'Toe') ?? body.at(0.07, 0, -0.01);
  return part(segment, body.at(-0.004, 0, 0.007), new Vector3(tip.x - 0.028 * body.size, tip.y, 0.001), {
    start: body.section(0.049, 0.026),
    end: body.section(0.043, 0.02),
    caps: body.caps(0.02, 0.03),
    tone: 'shoe',
  });
}

const FORWARD = new Vector3(1, 0, 0);
