"""One offline HTML page of a PyVista scene: to be turned with the mouse, without a kernel, a network or a program.

Unlike `plotter.export_html` it starts no web server, has words for those who cannot see it, and is always the same.
"""

from __future__ import annotations

import base64
import html
import importlib
import io
import json
import re
import zipfile
import zlib
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

from course_lib.files import atomic_write
from courseware.plots.scenes import SceneError

if TYPE_CHECKING:
    import pyvista

CURE = "pip install trame-vtk"

_ADDRESS = re.compile(r"""(?<=["{])[0-9A-Fa-f]{16}\b""")  # after a quote, or as instance:${...}; never a fraction
_SCRIPT = re.compile(r'<script type="module">(.*?)</script>', re.DOTALL)
_ICON = re.compile(r"`https://kitware\.github\.io/vtk-js/icon/[^`]*`")  # the viewer fetches its icons from there
_PAGE = """<!doctype html>
<html lang="en">
  <head>
    <meta charset="utf-8" />
    <meta name="viewport" content="width=device-width, initial-scale=1" />
    <meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline';
      style-src 'unsafe-inline'; img-src data: blob:; connect-src data: blob:; worker-src blob:" />
    <title>{title}</title>
    <meta name="description" content="{alt}" />
    <link rel="icon" href="data:," />
    <style>
      html, body {{ margin: 0; height: 100%; font-family: sans-serif; }}
      #help {{ position: fixed; z-index: 1; left: 0; bottom: 0; margin: 0; padding: 4px 8px; font-size: 13px;
        color: #222; background: rgba(255, 255, 255, 0.8); pointer-events: none; }}
      #reset {{ position: fixed; z-index: 1; right: 8px; top: 8px; font-size: 13px; }}
    </style>
  </head>
  <body>
    <p id="help">{caption} Drag to turn, wheel to zoom, Shift and drag to move.</p>
    <button id="reset" type="button" hidden>Reset view</button>
    <noscript>{alt}</noscript>
    <div class="content" role="img" aria-label="{alt}"></div>
    <script>
      window.global = window;
      function loadDataSet() {{
        const base64Str = "{scene}";
        OfflineLocalView.load(document.querySelector(".content"), {{ base64Str }});
      }}
    </script>
    <script type="module">
      const packed = Uint8Array.from(atob("{viewer}"), (letter) => letter.charCodeAt(0));
      const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
      const viewer = document.createElement("script");
      viewer.type = "module";
      viewer.textContent = await new Response(stream).text();
      document.head.append(viewer);
      const drawn = setInterval(() => {{
        const window3d = globalThis.renderWindow;
        const first = window3d?.getRenderers().find((one) => one.getActors().length);
        if (!first) return;
        clearInterval(drawn);
        const camera = first.getActiveCamera();
        const view = structuredClone(camera.get("position", "focalPoint", "viewUp"));
        const reset = document.getElementById("reset");
        reset.hidden = false;
        reset.onclick = () => {{
          camera.set(view);
          first.resetCameraClippingRange();
          window3d.render();
        }};
      }}, 100);
    </script>
  </body>
</html>
"""


class ScenePageError(RuntimeError):
    """No page can be made of a scene: what PyVista needs for it is missing, or it writes another kind of page."""


def write_page(plotter: pyvista.Plotter, path: Path, title: str, alt: str, legend: str = "") -> None:
    """Write the scene as one HTML page (`page_html`) into a folder that exists."""
    atomic_write(path, page_html(plotter, title, alt, legend))


def page_html(plotter: pyvista.Plotter, title: str, alt: str, legend: str = "") -> str:
    """Return the scene of a plotter as the text of one HTML page; the same text for the same scene.

    alt: what the scene shows, in a sentence, for those who cannot see it. legend: what is what, below the scene.
    """
    title, alt, legend = (" ".join(text.split()) for text in (title, alt, legend))
    if not title or len(alt.split()) < 4:
        raise SceneError(f"a scene has a title, and a text that says what it shows; got {title!r}, {alt!r}")
    if not plotter.actors:
        raise SceneError("the scene is empty: add something with plotter.add_mesh(...)")
    script = _SCRIPT.search(_trame("tools.vtksz2html").HTML_VIEWER_PATH.read_text(encoding="utf-8"))
    if script is None:
        raise ScenePageError(f"trame-vtk comes with a viewer of an unknown kind: {CURE} in environment.txt's versions")
    offline = _ICON.sub('"data:,"', script[1])
    packed = base64.b64encode(zlib.compress(offline.encode("utf-8"), 9)).decode("ascii")
    caption = f"{title}. {legend}." if legend else f"{title}."
    words = {"title": html.escape(title), "alt": html.escape(alt), "caption": html.escape(caption)}
    return _PAGE.format(**words, viewer=packed, scene=_archive(_scene_of(plotter)))


def _trame(module: str) -> ModuleType:
    try:
        return importlib.import_module(f"trame_vtk.{module}")
    except ImportError as error:
        raise ScenePageError(f"PyVista lacks what writes pages ({error}): {CURE}") from error


def _scene_of(plotter: pyvista.Plotter) -> dict:
    """The parts of a plotter's scene and the arrays in them, as the viewer reads them."""
    serializers = _trame("modules.vtk.serializers")
    window = plotter.render_window
    renderer = window.GetRenderers().GetFirstRenderer()
    camera = renderer.GetActiveCamera()
    renderer.UpdateLightsGeometryToFollowCamera()  # as drawing does, which needs OpenGL
    serializers.initialize_serializers()
    context = serializers.SynchronizationContext()
    context.set_ignore_last_dependencies(True)
    scene = serializers.serialize(None, window, 1, context, 1)
    scene["type"] = "vtkEGLRenderWindow"  # on every system
    scene["mtime"] = 1  # VTK counts the changes of all that it ever drew
    scene["extra"] = {
        "vtkRefId": serializers.reference_id(window),
        "centerOfRotation": camera.GetFocalPoint(),
        "camera": serializers.reference_id(camera),
    }
    arrays = {entry["hash"]: dict(entry) for entry in serializers.extract_array_hash(scene)}
    for name, entry in arrays.items():
        entry["content"] = context.get_cached_data_array(name, False)
    return {"hashes": arrays, "scene": scene}


def _archive(scene: dict) -> str:
    """The scene, its parts numbered instead of named by their address, as an archive without an hour, in base64."""
    numbers: dict[str, str] = {}
    parts = json.dumps(scene["scene"])
    parts = _ADDRESS.sub(lambda found: numbers.setdefault(found[0], f"part{len(numbers)}"), parts)
    text = json.dumps(scene | {"scene": json.loads(parts)}, separators=(",", ":"))
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        entry = zipfile.ZipInfo("index.json", date_time=(1980, 1, 1, 0, 0, 0))
        archive.writestr(entry, text, zipfile.ZIP_DEFLATED, 9)
    return base64.b64encode(file.getvalue()).decode("ascii")
