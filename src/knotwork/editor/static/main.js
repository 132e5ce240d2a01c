import { App } from "./app.js";

/** @type {any} */ (window).app = new App();
