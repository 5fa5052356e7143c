/** Everything on the page, and how it hangs together. */

import { byId } from './dom/h';
import { Room } from './model/room';
import { clock, type ClockText } from './panel/clock';
import { connection } from './panel/connection';
import { empty } from './panel/empty';
import { notices } from './panel/notices';
import { performers } from './panel/performers';
import { recorder } from './panel/recorder';
import { sheet } from './panel/sheet';
import { streams } from './panel/streams';
import { takes } from './panel/takes';
import { clock as clockText, secondsOfDay, timeOfDay } from './model/format';
import { findChannel } from './plots/channels';
import { PlotPanel } from './plots/panel';
import { Traces } from './plots/traces';
import { Refusal, json, words } from './protocol/api';
import type { Series, Tick } from './protocol/decode';
import { Live, type Connection } from './protocol/live';
import type { TextMessage } from './protocol/statistics';
import type { Scene, SubjectRecord, Take } from './protocol/types';
import { Stage, subjectColor } from './stage';
import { Player } from './transport/player';
import { type Transport, transport } from './transport/transport';
import { keysOf } from './view/bindings';
import { listen } from './view/keys';
import { ViewControls } from './view/controls';
import { toast } from './view/toast';

export class App {
  readonly room = new Room();
  readonly stage = new Stage(byId<HTMLCanvasElement>('stage-canvas'));
  readonly traces: Traces;
  readonly plots: PlotPanel;
  readonly controls: ViewControls;
  /** Plays takes; null while live. */
  player: Player | null = null;
  private readonly live: Live;
  private readonly refreshes: (() => void)[];
  private bar: Transport | null = null;
  /** What is added to a subject's clock to have the server's, seconds. */
  private readonly shifts = new Map<number, number>();
  /** Channels that are to be plotted once somebody has them. */
  private readonly wanted = new Set<string>();

  constructor() {
    this.live = new Live({
      tick: (tick) => this.tick(tick),
      series: (series) => this.series(series),
      text: (message) => this.text(message),
      unreadable: (reason) => this.room.notice(`The server speaks another version: reload this page (${reason})`),
      connection: (state, retryIn) => this.connected(state, retryIn),
    });
    const ask = this.live.askPlots.bind(this.live);
    this.traces = new Traces(
      ask,
      (subject) => this.room.takeOf(subject),
      () => this.plots.changed(),
      toast,
    );
    this.plots = new PlotPanel(byId('plots'), this.traces, this.plotSource(), () => this.controls.togglePlots());
    this.controls = new ViewControls(this);
    document.body.toggleAttribute('data-software', this.stage.stats().software);
    this.refreshes = this.parts();
    this.stage.onSelect = (id) => this.controls.follow(id);
    listen(keysOf(this));
    window.setInterval(() => document.hidden || this.refresh(), 100);
    this.run();
  }

  /** Shows what is known now, everywhere. */
  refresh(): void {
    for (const refresh of this.refreshes) refresh();
    this.coverStage();
  }

  /** Clock, names and tools lie over the stage: nobody is to stand under them. */
  private coverStage(): void {
    const [watch, tools] = [byId('clock'), byId('tools')];
    const height = this.stage.canvas.clientHeight;
    const top = (watch.hidden ? 0 : watch.offsetTop + watch.offsetHeight) + NAMES;
    this.stage.cover(Math.min(top, height / 3), Math.min(height - tools.offsetTop + 6, height / 4));
  }

  /** The theme has changed: what is drawn rather than styled is drawn anew. */
  restyle(): void {
    this.plots.restyle();
    this.bar?.redraw();
  }

  private parts(): (() => void)[] {
    const { room } = this;
    const color = (subject: Parameters<typeof subjectColor>[0]): string => `#${subjectColor(subject).getHexString()}`;
    const actions = {
      follow: (id: number) => this.controls.follow(room.followed === id ? null : id),
      hide: (id: number) => this.controls.hide(id),
      color,
    };
    const go = (take: Take, frame: number): void => this.player?.goToOf(take, frame);
    const blocks = [performers(room, actions), takes(room, go), recorder(room, toast), streams(room), notices(room)];
    byId('sheet').append(...blocks.map((block) => block.element));
    return [
      ...blocks.map((block) => block.refresh),
      clock(byId('clock'), room, () => this.takeClock()),
      connection(byId('connection'), room),
      empty(byId('empty'), room),
      sheet(byId('panel'), byId<HTMLButtonElement>('handle'), byId('summary'), room),
    ];
  }

  /** Plots and the playhead move more often than numbers are written. */
  private run(): void {
    let drawn = 0;
    const frame = (now: number): void => {
      this.bar?.refresh();
      if (now - drawn >= PLOT_INTERVAL) {
        drawn = now;
        this.plots.refresh();
      }
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  private tick({ clock: now, records }: Tick): void {
    for (const record of records) this.learnShift(record, now);
    this.show(records);
  }

  private show(records: SubjectRecord[]): void {
    this.room.take(records);
    this.stage.update(records);
  }

  private series(series: Series): void {
    this.traces.take(series, (subject) => this.shifts.get(subject) ?? 0);
  }

  private text(message: TextMessage): void {
    switch (message.type) {
      case 'scene':
        return this.describe(message);
      case 'statistics':
        return this.room.count(message);
      case 'recorder':
        this.room.recorder = message;
        return;
      case 'notice':
        return this.room.notice(message.text);
      case 'ended':
        this.room.ended = true;
    }
  }

  private describe(scene: Scene): void {
    const first = this.room.scene === null;
    this.room.describe(scene);
    byId('source').textContent = scene.source.join(', ');
    document.title = `${scene.mode === 'live' ? 'Live' : scene.takes.map((take) => take.file).join(', ')} – posewire`;
    this.stage.setSubjects(scene.subjects);
    this.stage.update([...this.room.records.values()]);
    // A server that was started again has the same takes: the playhead stays where it is.
    if (scene.mode === 'takes' && !this.player) this.play();
    this.controls.described(first);
    this.plotWanted();
    this.refresh();
  }

  private play(): void {
    this.player = new Player(this.room.takes, (records) => this.show(records));
    this.bar = transport(byId('transport'), this.player);
  }

  private connected(state: Connection, retryIn: number): void {
    this.room.connection = state;
    this.room.retryAt = Date.now() + retryIn * 1000;
    if (state === 'lost') void this.askWhy();
  }

  /** A WebSocket does not say why it was refused; the same question over HTTP is answered. */
  private async askWhy(): Promise<void> {
    try {
      await json<Scene>('/api/scene');
    } catch (error) {
      if (error instanceof Refusal) this.room.refusal = words(error);
    }
  }

  /** A source's clock runs as the server's does: the distance changes only when it was set or began anew. */
  private learnShift(record: SubjectRecord, now: number): void {
    const shift = now - record.age - record.time;
    const held = this.shifts.get(record.id);
    if (held === undefined || Math.abs(held - shift) > 0.5) this.shifts.set(record.id, shift);
  }

  /** Adds a channel by its key: as soon as somebody has it. */
  plot(key: string): void {
    const channel = findChannel(this.room.subjects, key);
    if (!channel) this.wanted.add(key);
    else if (!this.traces.keys().has(key)) this.traces.toggle(channel);
  }

  /** What a subject sends becomes known bit by bit: so do its channels. */
  private plotWanted(): void {
    const wanted = [...this.wanted];
    this.wanted.clear();
    for (const key of wanted) this.plot(key);
  }

  private plotSource() {
    return {
      subjects: () => this.room.subjects,
      span: () => this.player?.span ?? null,
      head: () => this.player?.playhead.position ?? null,
      seek: (seconds: number) => this.player?.seek(seconds),
    };
  }

  private takeClock(): ClockText | null {
    if (!this.player) return null;
    const { leading, playhead, span } = this.player;
    if (!leading) return null;
    const label = `Frame ${this.player.frame().toLocaleString('en')} of ${Math.max(leading.frames - 1, 0).toLocaleString('en')}`;
    const start = leading.start_timecode === null ? null : secondsOfDay(leading.start_timecode);
    if (start === null) return { time: clockText(playhead.position - span.from), label };
    return { time: timeOfDay(start + playhead.position - leading.start_s, 3), label: `${label}, timecode, UTC` };
  }
}

/** Pixels that the names over heads take. */
const NAMES = 46;

/** Milliseconds between two drawings of plots: 15 a second are enough for a line that rolls. */
const PLOT_INTERVAL = 66;
