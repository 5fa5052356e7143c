import { Box3, NeutralToneMapping, Scene, Vector3, WebGLRenderer } from 'three';
import type { Subject, SubjectRecord } from '../protocol/types';
import { Brush } from './brush';
import { Eye } from './camera';
import { draw } from './draw';
import { DEFAULTS, type Preset, type StageOptions, type StageStats, type ViewState } from './options';
import { Performer } from './performer';
import { type Pickable, pickPoints } from './pick';
import { Pointer } from './pointer';
import { Pulse } from './pulse';
import { AdaptiveQuality, QUALITY, type QualityStep, SLOW_START, STILL } from './quality';
import { Floor } from './room/floor';
import { Lights } from './room/lights';
import { Sky } from './room/sky';
import { type Look, LOOKS } from './room/theme';
import { Reach } from './reach';
import { looksSame } from './same';
import { drawnBySoftware } from './software';
import { Tags } from './tags';

export type { Preset, StageOptions, StageStats, Theme, ViewState } from './options';
export { subjectColor } from './palette';

/**
 * The room in which performers are drawn. Canonical coordinates throughout: metres, X forward, Y left, Z up, which is
 * also how the scene is, so that nothing is ever turned.
 *
 * It draws only when something changed: a sample, an option, the eye.
 */
export class Stage {
  /** Called with the subject that was clicked or tapped, null for none. */
  onSelect: ((id: number | null) => void) | null = null;
  private readonly software = drawnBySoftware();
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly eye: Eye;
  private readonly brush: Brush;
  private readonly floor: Floor;
  private readonly sky: Sky;
  private readonly lights: Lights;
  private readonly tags: Tags;
  private readonly quality: AdaptiveQuality;
  private readonly pointer: Pointer;
  private readonly pulse: Pulse;
  private readonly resized: ResizeObserver;
  private options: StageOptions = { ...DEFAULTS };
  private look: Look = LOOKS.dark;
  private performers = new Map<number, Performer>();
  private waiting = new Map<number, SubjectRecord>();
  private followed: number | null = null;
  private size = { width: 1, height: 1 };
  private covered = { top: 0, bottom: 0 };
  private posesChanged = true;
  private viewChanged = true;
  /** From where everybody is looked at, and for how many that view was made. */
  private side: Preset = 'free';
  private framed = 0;
  private wasFramed = false;
  /** Where those who are shown were in the last seconds. */
  private readonly reach = new Reach();
  /** Whether whom it follows has yet to be brought into the middle. */
  private centring = false;
  /** What the picture is drawn with now. */
  private step: QualityStep;
  private restedFor = 0;

  /** Throws where the browser has no WebGL 2. */
  constructor(readonly canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({ canvas, antialias: !this.software, powerPreference: 'high-performance' });
    this.renderer.toneMapping = NeutralToneMapping;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.autoUpdate = false;
    this.quality = new AdaptiveQuality(this.software ? SLOW_START : 0);
    this.step = QUALITY[this.quality.step] ?? STILL;
    this.floor = new Floor(this.scene);
    this.sky = new Sky(this.scene);
    this.lights = new Lights(this.scene);
    this.brush = new Brush(this.scene);
    this.tags = new Tags(this.scene);
    this.eye = new Eye(canvas, () => (this.viewChanged = true));
    this.pointer = new Pointer(
      canvas,
      this.eye.camera,
      () => this.bodies(),
      (id) => this.onSelect?.(id),
    );
    this.pulse = new Pulse((seconds, sinceDrawn) => this.tick(seconds, sinceDrawn));
    this.setOptions({});
    this.resized = new ResizeObserver(() => this.resize());
    this.resized.observe(canvas);
    this.resize();
    canvas.addEventListener('webglcontextrestored', this.onRestored);
    this.pulse.start();
  }

  /** Whom the stage knows. Those who were there before keep where they were last and their trails. */
  setSubjects(subjects: Subject[]): void {
    const before = this.performers;
    this.performers = new Map(
      subjects.map((subject) => {
        const old = before.get(subject.id);
        const same = old && JSON.stringify(old.subject) === JSON.stringify(subject);
        return [subject.id, same ? old : new Performer(subject)];
      }),
    );
    for (const [id, record] of this.waiting) this.performers.get(id)?.take(record);
    this.posesChanged = true;
  }

  /** Takes the newest samples; subjects without one stay as they are. */
  update(records: SubjectRecord[]): void {
    for (const record of records) {
      const before = this.waiting.get(record.id);
      if (before && looksSame(before, record)) continue;
      this.waiting.set(record.id, record);
      this.performers.get(record.id)?.take(record);
      this.posesChanged = true;
    }
  }

  setOptions(options: Partial<StageOptions>): void {
    this.options = { ...this.options, ...options };
    this.look = LOOKS[this.options.theme];
    this.renderer.setClearColor(this.look.horizon);
    this.renderer.toneMappingExposure = this.look.exposure;
    for (const part of [this.floor, this.sky, this.lights]) part.wear(this.look);
    this.posesChanged = true;
  }

  /** Goes along with a performer from now on, or with none. */
  follow(id: number | null): void {
    this.followed = id;
    this.centring = id !== null;
    this.framed = 0;
    this.eye.follow(this.goal());
    this.posesChanged = true;
  }

  /** Looks at whom it follows, or else at all, from a side: of one performer from its own. */
  preset(preset: Preset): void {
    this.side = preset;
    this.eye.chosen = this.centring = false;
    this.reach.forget();
    this.eye.look(preset, this.looked(), this.facing());
    this.viewChanged = true;
  }

  /** So many CSS pixels above and below are covered by other things: whom it frames is between them. */
  cover(top: number, bottom: number): void {
    if (top === this.covered.top && bottom === this.covered.bottom) return;
    this.covered = { top, bottom };
    this.eye.resize({ ...this.size, ...this.covered });
    this.framed = 0;
    this.posesChanged = true;
  }

  view(): ViewState {
    return { ...this.eye.view(), follow: this.followed };
  }

  setView(view: ViewState): void {
    this.eye.setView(view);
    this.followed = view.follow;
    this.viewChanged = true;
  }

  /** What is seen now, as PNG. */
  async screenshot(): Promise<Blob> {
    this.useStep(STILL);
    this.posesChanged = true;
    this.render();
    return new Promise((resolve, reject) => {
      // Taken in the same task as drawn: a browser may clear the canvas after it.
      this.canvas.toBlob(
        (blob) => (blob ? resolve(blob) : reject(new Error('the browser made no picture'))),
        'image/png',
      );
    });
  }

  stats(): StageStats {
    const { calls, triangles } = this.renderer.info.render;
    const positions = (id: number) => this.performers.get(id)?.pose.position.slice() ?? new Float32Array();
    return { fps: this.pulse.fps(), quality: this.quality.step, software: this.software, calls, triangles, positions };
  }

  dispose(): void {
    this.pulse.stop();
    this.resized.disconnect();
    this.canvas.removeEventListener('webglcontextrestored', this.onRestored);
    for (const part of [
      this.pointer,
      this.eye,
      this.brush,
      this.floor,
      this.sky,
      this.lights,
      this.tags,
      this.renderer,
    ])
      part.dispose();
  }

  /** One frame of the screen; true when something was drawn that tells how quick drawing is. */
  private tick(seconds: number, sinceDrawn: number | null): boolean {
    if (sinceDrawn !== null) this.quality.frame(sinceDrawn);
    this.centreFollowed();
    this.frameEverybody();
    if (this.eye.update(seconds, this.goal())) this.viewChanged = true;
    if (!this.posesChanged && !this.viewChanged) return this.rest(seconds);
    this.restedFor = 0;
    this.useStep(QUALITY[this.quality.step] ?? STILL);
    this.render();
    return true;
  }

  /** Nothing moves: after a moment the same picture once more, as well as can be. */
  private rest(seconds: number): false {
    this.restedFor += seconds;
    if (this.restedFor < STILL_AFTER || this.step.pixelRatio >= STILL.pixelRatio) return false;
    this.useStep(STILL);
    this.render();
    return false;
  }

  private render(): void {
    this.drawPerformers();
    this.tags.place(this.eye.camera, this.size.width, this.size.height);
    this.sky.surround(this.eye.camera.position);
    this.renderer.render(this.scene, this.eye.camera);
    this.posesChanged = this.viewChanged = false;
  }

  private drawPerformers(): void {
    const shown = this.shown();
    if (this.posesChanged) this.attend();
    this.brush.begin();
    const soft = this.look.shadow * (this.step.shadows > 0 ? 0.42 : 0.85);
    for (const performer of shown) {
      const manner = { look: this.look, options: this.options, soft, lavish: this.step.shadows > 0 };
      const followed = performer.subject.id === this.followed;
      draw(performer, this.brush, { ...manner, followed, pixels: this.pixels(performer) });
    }
    this.brush.end();
    this.tags.write(this.options.names ? shown : [], this.look);
    this.renderer.shadowMap.needsUpdate = this.posesChanged;
  }

  /** How many pixels high a person is where a performer stands. */
  private pixels(performer: Performer): number {
    const { camera } = this.eye;
    const away = performer.centre()?.distanceTo(camera.position) ?? Infinity;
    return (
      (1.75 * this.size.height * this.renderer.getPixelRatio()) /
      (2 * Math.tan((camera.fov * Math.PI) / 360) * Math.max(away, 0.1))
    );
  }

  /** Light and the clear part of the floor go where there is something to see. */
  private attend(): void {
    const all = around(this.outline(null));
    this.floor.attend(all.centre, all.radius);
    const one = this.goal() ? around(this.outline(this.followed)) : all;
    this.lights.attend(one.centre, one.radius);
  }

  /** Until somebody moves the view by hand, everyone is in it: at first, when there are more, when one walks out. */
  private frameEverybody(): void {
    if (this.eye.chosen || this.followed !== null || !this.posesChanged) return;
    const count = this.shown().filter((performer) => performer.centre()).length;
    if (count === 0) return;
    const outline = this.outline(null);
    if (this.framed !== count) this.reach.forget();
    this.reach.add(outline);
    if (this.framed !== count) this.frameFirst();
    else if (!outline.every((place) => this.eye.sees(place))) this.eye.widen(this.reach.corners(outline, this.beyond()));
    this.framed = count;
  }

  /** Metres that are seen beyond where everybody is: a narrow picture goes along sooner, or all were small in it. */
  private beyond(): number {
    return 2 * Math.min(this.size.width / this.size.height, 1) ** 2;
  }

  private frameFirst(): void {
    const first = !this.wasFramed;
    this.wasFramed = true;
    this.eye.look(this.side, this.looked(), this.facing(), first || undefined);
  }

  private centreFollowed(): void {
    if (!this.centring || !this.goal()) return;
    this.centring = false;
    this.eye.follow(this.goal());
    this.eye.centre(this.looked());
  }

  /** What views from a side show: whom it follows, with some room, or all. */
  private looked(): Vector3[] {
    const one = this.goal() && this.followed !== null ? this.performers.get(this.followed) : undefined;
    return one?.room() ?? this.shownRoom();
  }

  private shownRoom(): Vector3[] {
    const points = this.shown().flatMap((performer) => performer.room());
    return points.length > 0 ? points : this.outline(null);
  }

  /** Where the one who is looked at faces; of several, ahead is +X. */
  private facing(): number {
    const shown = this.shown();
    const one = this.followed === null ? shown[0] : this.performers.get(this.followed);
    return one && (this.followed !== null || shown.length === 1) ? one.facing() : 0;
  }

  private shown(): Performer[] {
    return [...this.performers.values()].filter(({ subject }) => !this.options.hidden.has(subject.id));
  }

  /** Points around one subject or all that are shown; around a person's room at the origin when there are none. */
  private outline(id: number | null): Vector3[] {
    const one = id === null ? undefined : this.performers.get(id);
    const points = (one ? [one] : this.shown()).flatMap((performer) => performer.outline());
    return points.length > 0 ? points : [new Vector3(-0.8, -0.8, 0), new Vector3(0.8, 0.8, 1.75)];
  }

  private goal(): Vector3 | null {
    return this.followed === null ? null : (this.performers.get(this.followed)?.centre() ?? null);
  }

  private useStep(step: QualityStep): void {
    if (this.step === step) return;
    this.step = step;
    this.fitCanvas();
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.size = { width, height };
    this.framed = 0;
    this.fitCanvas();
    // A canvas of a new size is empty until it is drawn.
    this.render();
  }

  private fitCanvas(): void {
    const { width, height } = this.size;
    const { pixelRatio, shadows } = this.step;
    this.renderer.setPixelRatio(this.step === STILL ? pixelRatio : Math.min(window.devicePixelRatio, pixelRatio));
    this.renderer.setSize(width, height, false);
    this.brush.resize(width, height);
    this.eye.resize({ width, height, ...this.covered });
    this.lights.shadows = shadows;
    this.posesChanged = true;
  }

  private readonly onRestored = (): void => {
    this.posesChanged = true;
  };

  private bodies(): Pickable[] {
    return this.shown().map(({ subject, pose }) => {
      const parents = subject.segments.map((segment) => segment.parent);
      return { id: subject.id, points: pickPoints(pose.position, parents) };
    });
  }
}

/** The middle of points, and how far they reach from it over the ground. */
function around(points: Vector3[]): { centre: Vector3; radius: number } {
  const box = new Box3().setFromPoints(points);
  return { centre: box.getCenter(new Vector3()), radius: box.getSize(new Vector3()).setZ(0).length() / 2 };
}

/** How long nothing moves, in seconds, until the picture is drawn once more as well as can be. */
const STILL_AFTER = 0.3;
