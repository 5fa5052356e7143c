/** What the person at the page chooses: whom to follow, what to show, the theme; to keep the view and to share it. */

import type { App } from '../app';
import { byId } from '../dom/h';
import { nameOf } from '../protocol/types';
import type { Preset } from '../stage';
import { savePicture } from './screenshot';
import { type SharedView, readHash, writeHash } from './share';
import { type Theme, initialTheme, showTheme } from './theme';
import { toast } from './toast';
import { SHOWN, type Shown, type ToolState, pageActions, tools } from './tools';
import { openHelp } from './help';

export class ViewControls {
  private readonly show: Record<Shown, boolean> = {
    names: true,
    axes: false,
    trails: false,
    com: false,
    markers: true,
  };
  private theme: Theme = initialTheme();
  private readonly showTools: (state: ToolState) => void;

  constructor(private readonly app: App) {
    const actions = this.actions();
    this.showTools = tools(byId('tools'), actions);
    pageActions(byId('actions'), actions);
    showTheme(this.theme, false);
    this.apply();
    window.addEventListener('hashchange', () => this.restore(readHash(location.hash)));
  }

  /** The scene was described: the first time, the view of the address is taken. */
  described(first: boolean): void {
    if (first) this.restore(readHash(location.hash));
    this.apply();
  }

  follow = (id: number | null): void => {
    const { room, stage } = this.app;
    if (room.followed === id) return;
    room.followed = id;
    room.revision++;
    stage.follow(id);
    const subject = id === null ? undefined : room.subject(id);
    toast(subject ? `Following ${nameOf(subject)}` : 'Following nobody');
    this.app.refresh();
  };

  /** The next performer who is not hidden, and after the last nobody. */
  followNext = (): void => {
    const { room } = this.app;
    const ids = room.subjects.filter((subject) => !room.hidden.has(subject.id)).map((subject) => subject.id);
    const place = room.followed === null ? -1 : ids.indexOf(room.followed);
    this.follow(ids[place + 1] ?? null);
  };

  hide = (id: number): void => {
    const { hidden } = this.app.room;
    if (!hidden.delete(id)) hidden.add(id);
    this.apply();
    this.app.refresh();
  };

  preset = (preset: Preset): void => this.app.stage.preset(preset);

  toggle = (what: Shown): void => {
    this.show[what] = !this.show[what];
    this.apply();
  };

  togglePlots = (): void => {
    const { element } = this.app.plots;
    element.hidden = !element.hidden;
    if (!element.hidden && this.app.traces.all.length === 0 && this.app.room.subjects.length > 0) this.app.plots.pick();
    this.apply();
  };

  toggleTheme = (): void => {
    this.theme = this.theme === 'dark' ? 'light' : 'dark';
    showTheme(this.theme, true);
    this.apply();
    this.app.restyle();
  };

  help = (): void => openHelp(this.app.player !== null);

  screenshot = async (): Promise<void> => {
    try {
      toast(`Saved ${savePicture(await this.app.stage.screenshot())}`);
    } catch (error) {
      toast(`No picture could be taken: ${error instanceof Error ? error.message : String(error)}`);
    }
  };

  share = async (): Promise<void> => {
    history.replaceState(null, '', `#${writeHash(this.current())}`);
    try {
      await navigator.clipboard.writeText(location.href);
      toast('The address of this view is in the clipboard');
    } catch {
      // Browsers give pages without encryption no clipboard unless they are of the same machine.
      toast('The address bar has the address of this view');
    }
  };

  private actions() {
    const { preset, toggle: show, togglePlots: plots, screenshot, share, toggleTheme: theme, help } = this;
    return { preset, show, plots, screenshot: () => void screenshot(), share: () => void share(), theme, help };
  }

  private apply(): void {
    const { stage, room, plots } = this.app;
    stage.setOptions({ ...this.show, theme: this.theme, hidden: new Set(room.hidden) });
    this.showTools({ show: this.show, plots: !plots.element.hidden });
  }

  private current(): SharedView {
    const { stage, room, player, traces } = this.app;
    const { position, target } = stage.view();
    const view: SharedView = {
      camera: { position, target },
      show: SHOWN.filter((what) => this.show[what]),
      hidden: [...room.hidden],
      plots: traces.all.map((trace) => trace.key),
    };
    if (room.followed !== null) view.follow = room.followed;
    if (player) view.frame = player.frame();
    return view;
  }

  private restore(view: SharedView): void {
    const { stage, room, player } = this.app;
    if (view.show) for (const what of SHOWN) this.show[what] = view.show.includes(what);
    for (const id of view.hidden ?? []) if (room.subject(id)) room.hidden.add(id);
    const follow = view.follow !== undefined && room.subject(view.follow) ? view.follow : null;
    if (view.camera) stage.setView({ ...view.camera, follow });
    else if (follow !== null) stage.follow(follow);
    if (follow !== null) room.followed = follow;
    if (view.frame !== undefined) player?.goTo(view.frame);
    view.plots?.forEach((key) => this.app.plot(key));
    if (view.plots) this.app.plots.element.hidden = false;
    room.revision++;
    this.apply();
  }
}
