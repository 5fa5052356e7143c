/** The page: puts its parts together, and keeps them at what is known now. */

import 'uplot/dist/uPlot.min.css';
import './style/index.css';
import { App } from './app';

const app = new App();
// What tests and the console of the browser look at.
Object.assign(window, { posewire: app });
