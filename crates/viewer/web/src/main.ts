import { Stage } from './stage';

const canvas = document.querySelector<HTMLCanvasElement>('#stage-canvas');
if (canvas) new Stage(canvas);
