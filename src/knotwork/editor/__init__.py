"""The browser editor (chapter 7): the geometry runs here, the page draws and sends strokes."""
