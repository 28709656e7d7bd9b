// SPDX-License-Identifier: BSD-3-Clause
// The page in a frame of its own, and the widget's channel between it and the kernel. Nothing else reaches the frame.

function render({ model, el }) {
  const frame = document.createElement("iframe");
  frame.name = "nanotouch-framed";
  frame.title = "nanotouch";
  frame.setAttribute("sandbox", "allow-scripts allow-downloads");
  frame.style.cssText = `width:100%;height:${model.get("height")}px;border:0`;
  frame.srcdoc = model.get("page");
  el.append(frame);

  const fromFrame = ({ source, data }) => {
    if (source === frame.contentWindow && data?.nanotouch === 1) model.send(data.message);
  };
  const fromKernel = (content, buffers) => {
    const bytes = buffers?.[0];
    if (bytes) {
      const copy = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
      frame.contentWindow?.postMessage({ nanotouch: 1, bytes: copy }, "*", [copy]);
    } else if (content.message) frame.contentWindow?.postMessage({ nanotouch: 1, message: content.message }, "*");
  };
  window.addEventListener("message", fromFrame);
  model.on("msg:custom", fromKernel);
  return () => {
    window.removeEventListener("message", fromFrame);
    model.off("msg:custom", fromKernel);
  };
}

export default { render };
