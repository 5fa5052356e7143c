import { type Camera, Raycaster, Vector2 } from 'three';
import { type Pickable, pick } from './pick';

/** Who is under the mouse or a finger: told when clicked or tapped, shown by the cursor before. */
export class Pointer {
  private pressed: { x: number; y: number } | null = null;
  private readonly caster = new Raycaster();

  /** `bodies` are asked for when they are needed; `picked` gets whom a click meets, or null. */
  constructor(
    private readonly canvas: HTMLElement,
    private readonly camera: Camera,
    private readonly bodies: () => Pickable[],
    private readonly picked: (id: number | null) => void,
  ) {
    canvas.addEventListener('pointerdown', this.onDown);
    canvas.addEventListener('pointermove', this.onMove);
    canvas.addEventListener('pointerup', this.onUp);
  }

  dispose(): void {
    this.canvas.removeEventListener('pointerdown', this.onDown);
    this.canvas.removeEventListener('pointermove', this.onMove);
    this.canvas.removeEventListener('pointerup', this.onUp);
  }

  private readonly onDown = (event: PointerEvent): void => {
    this.pressed = event.isPrimary ? { x: event.clientX, y: event.clientY } : null;
  };

  private readonly onMove = (event: PointerEvent): void => {
    if (event.pointerType !== 'mouse' || event.buttons !== 0) return;
    this.canvas.style.cursor = this.under(event) === null ? '' : 'pointer';
  };

  private readonly onUp = (event: PointerEvent): void => {
    const from = this.pressed;
    this.pressed = null;
    // Further than a hand trembles: the view was turned.
    if (!from || Math.hypot(event.clientX - from.x, event.clientY - from.y) > 5) return;
    this.picked(this.under(event));
  };

  private under(event: PointerEvent): number | null {
    const frame = this.canvas.getBoundingClientRect();
    const x = ((event.clientX - frame.left) / frame.width) * 2 - 1;
    const y = 1 - ((event.clientY - frame.top) / frame.height) * 2;
    this.caster.setFromCamera(new Vector2(x, y), this.camera);
    return pick(this.caster.ray, this.bodies());
  }
}
