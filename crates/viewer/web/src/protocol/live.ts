/** The connection to the server: it comes back by itself, a little later after each attempt that failed. */

import { MalformedMessage, type Series, type Tick, decodeMessage } from './decode';
import type { TextMessage } from './statistics';

export type Connection = 'connecting' | 'open' | 'lost';

export interface LiveEvents {
  tick(tick: Tick): void;
  series(series: Series): void;
  text(message: TextMessage): void;
  /** A message that cannot be read: the server is of another version than the page. */
  unreadable(reason: string): void;
  /** `retryIn` is in seconds, while the connection is lost. */
  connection(state: Connection, retryIn: number): void;
}

export interface PlotRequest {
  id: number;
  subject: number;
  channel: string;
}

export class Live {
  private socket: WebSocket | null = null;
  private failures = 0;
  private plots: PlotRequest[] = [];
  private rate = RATE;
  private timer = 0;

  constructor(private readonly events: LiveEvents) {
    this.open();
    // A page that comes back from the background, or a network that does, need not wait.
    window.addEventListener('online', () => this.retry());
    document.addEventListener('visibilitychange', () => this.seen(!document.hidden));
  }

  /** Asks for these channels and no others. */
  askPlots(channels: PlotRequest[]): void {
    this.plots = channels;
    this.send({ type: 'plot', channels });
  }

  private open(): void {
    this.events.connection('connecting', 0);
    const scheme = location.protocol === 'https:' ? 'wss:' : 'ws:';
    const socket = new WebSocket(`${scheme}//${location.host}/ws`);
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => this.opened();
    socket.onmessage = (event) => this.take(event.data as string | ArrayBuffer);
    socket.onclose = () => this.closed(socket);
    this.socket = socket;
  }

  private opened(): void {
    this.failures = 0;
    this.events.connection('open', 0);
    this.send({ type: 'rate', hz: this.rate });
    if (this.plots.length > 0) this.send({ type: 'plot', channels: this.plots });
  }

  private closed(socket: WebSocket): void {
    if (this.socket !== socket) return;
    this.socket = null;
    const wait = backoff(this.failures++, Math.random());
    this.events.connection('lost', wait);
    this.timer = window.setTimeout(() => this.open(), wait * 1000);
  }

  /** Nobody looks at a page in the background: it asks for a tick a second, to know the states. */
  private seen(visible: boolean): void {
    this.rate = visible ? RATE : 1;
    this.send({ type: 'rate', hz: this.rate });
    if (visible) this.retry();
  }

  private retry(): void {
    if (this.socket) return;
    window.clearTimeout(this.timer);
    this.open();
  }

  private take(data: string | ArrayBuffer): void {
    try {
      this.read(data);
    } catch (error) {
      if (!(error instanceof MalformedMessage || error instanceof SyntaxError)) throw error;
      this.events.unreadable(error.message);
    }
  }

  private read(data: string | ArrayBuffer): void {
    if (typeof data === 'string') return this.events.text(JSON.parse(data) as TextMessage);
    const message = decodeMessage(data);
    if (message.kind === 'tick') this.events.tick(message.tick);
    else this.events.series(message.series);
  }

  private send(message: object): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }
}

/**
 * Seconds until the next attempt: from 0.25 s it doubles to 4 s, give or take a quarter. `chance`, 0 to 1, spreads the
 * pages of a room, which all lost the server at the same moment.
 */
export function backoff(failures: number, chance: number): number {
  return Math.min(4, 0.25 * 2 ** failures) * (0.75 + 0.5 * chance);
}

/** Ticks a second that a page asks for. */
const RATE = 30;
