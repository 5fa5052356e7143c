import {
  CanvasTexture,
  type Color,
  LinearMipmapLinearFilter,
  MathUtils,
  type PerspectiveCamera,
  Sprite,
  SpriteMaterial,
  SRGBColorSpace,
  type Vector3,
} from 'three';
import type { Look } from './room/theme';

/** What a name tag says. */
export interface TagText {
  name: string;
  /** Small, under the name: what is missing of the stream. */
  note: string;
  /** Beside the name, when it is not live. */
  state: '' | 'STALE' | 'LOST';
  color: Color;
}

/** A rectangle of the picture, CSS pixels from its upper left. */
export interface Place {
  left: number;
  right: number;
  top: number;
  bottom: number;
}

/** A name over a performer's head, of the same size wherever it is. */
export class Tag {
  readonly sprite: Sprite;
  private drawn = '';
  private size = { width: 1, height: 1 };
  /** CSS pixels on the screen. */
  private height = 1;

  constructor() {
    const material = new SpriteMaterial({
      transparent: true,
      depthTest: false,
      depthWrite: false,
      sizeAttenuation: false,
      toneMapped: false,
    });
    this.sprite = new Sprite(material);
    // A little above its place on the screen, so that it hides nobody from above either.
    this.sprite.center.set(0.5, -ABOVE);
    this.sprite.renderOrder = 30;
    this.sprite.visible = false;
  }

  /** Draws the text, if it is another than before. */
  write(text: TagText, look: Look): void {
    const key = [text.name, text.note, text.state, text.color.getHexString(), look.tag.ground].join('\n');
    if (key === this.drawn) return;
    this.drawn = key;
    const canvas = paint(text, look);
    this.size = { width: canvas.width / DENSITY, height: canvas.height / DENSITY };
    this.sprite.material.map?.dispose();
    const texture = new CanvasTexture(canvas);
    texture.colorSpace = SRGBColorSpace;
    // Smaller than painted where it is far away, or where a slow machine draws few pixels.
    texture.minFilter = LinearMipmapLinearFilter;
    this.sprite.material.map = texture;
    this.sprite.material.needsUpdate = true;
  }

  /** Puts it over a place, in a picture of so many CSS pixels; a little smaller when far away. Gives where that is. */
  place(at: Vector3, camera: PerspectiveCamera, width: number, height: number): Place {
    this.sprite.position.copy(at);
    const away = camera.position.distanceTo(at);
    const pixel = (2 * Math.tan(MathUtils.degToRad(camera.fov / 2))) / Math.max(height, 1);
    const part = MathUtils.clamp(8 / away, 0.72, 1);
    const size = pixel * part;
    this.sprite.scale.set(this.size.width * size, this.size.height * size, 1);
    this.sprite.material.opacity = MathUtils.clamp(1.3 - away / 60, 0.75, 1);
    this.height = this.size.height * part;
    const { x, y } = at.clone().project(camera);
    const middle = ((x + 1) / 2) * width;
    const bottom = ((1 - y) / 2) * height - ABOVE * this.height;
    const half = (this.size.width * part) / 2;
    return { left: middle - half, right: middle + half, top: bottom - this.height, bottom };
  }

  /** Moves it so many CSS pixels up from there. */
  lift(pixels: number): void {
    this.sprite.center.y = -ABOVE - pixels / this.height;
  }

  dispose(): void {
    this.sprite.material.map?.dispose();
    this.sprite.material.dispose();
  }
}

/** How far above its place it is, in its own heights. */
const ABOVE = 0.55;
/** Texture pixels for each CSS pixel. */
const DENSITY = 2;
const NAME = '600 13px system-ui, sans-serif';
const SMALL = '500 10.5px system-ui, sans-serif';
const INK = { STALE: ['#e9b949', '#2b2108'], LOST: ['#d9534f', '#ffffff'] } as const;

function paint(text: TagText, look: Look): HTMLCanvasElement {
  const canvas = document.createElement('canvas');
  const pen = canvas.getContext('2d');
  if (!pen) return canvas;
  const wide = measure(pen, text);
  const height = text.note ? 38 : 24;
  canvas.width = Math.ceil(wide.all + 2 * MARGIN) * DENSITY;
  canvas.height = (height + 2 * MARGIN) * DENSITY;
  pen.scale(DENSITY, DENSITY);
  pen.translate(MARGIN, MARGIN);
  ground(pen, wide.all, height, look);
  pen.textBaseline = 'middle';
  dot(pen, text.color, 13, 12);
  write(pen, text.name, NAME, look.tag.ink, 22, 12.5);
  if (text.state) badge(pen, text.state, 22 + wide.name + 7, wide.state);
  if (text.note) write(pen, text.note, SMALL, look.tag.faint, 22, 27.5);
  return canvas;
}

/** Pixels around the tag, for its edge. */
const MARGIN = 2;

function measure(pen: CanvasRenderingContext2D, text: TagText): { name: number; state: number; all: number } {
  pen.font = NAME;
  const name = pen.measureText(text.name).width;
  pen.font = SMALL;
  const state = text.state ? pen.measureText(text.state).width + 10 : 0;
  const note = pen.measureText(text.note).width;
  return { name, state, all: 22 + Math.max(name + (state ? state + 7 : 0), note) + 10 };
}

function ground(pen: CanvasRenderingContext2D, width: number, height: number, look: Look): void {
  pen.beginPath();
  pen.roundRect(0, 0, width, height, height > 30 ? 9 : 12);
  pen.fillStyle = look.tag.ground;
  pen.fill();
  pen.strokeStyle = look.tag.edge;
  pen.stroke();
}

function dot(pen: CanvasRenderingContext2D, color: Color, x: number, y: number): void {
  pen.beginPath();
  pen.arc(x, y, 4, 0, 2 * Math.PI);
  pen.fillStyle = `#${color.getHexString()}`;
  pen.fill();
}

function badge(pen: CanvasRenderingContext2D, state: 'STALE' | 'LOST', x: number, width: number): void {
  pen.beginPath();
  pen.roundRect(x, 5, width, 14, 7);
  pen.fillStyle = INK[state][0];
  pen.fill();
  write(pen, state, SMALL, INK[state][1], x + 5, 12.5);
}

function write(pen: CanvasRenderingContext2D, text: string, font: string, ink: string, x: number, y: number): void {
  pen.font = font;
  pen.fillStyle = ink;
  pen.fillText(text, x, y);
}
