// The panel "Speed", which measures steps per second in a worker.

const $ = (id) => document.getElementById(id);

export function speedPanel(module) {
  const end = (worker, message) => {
    worker.terminate();
    $("measure").disabled = false;
    $("speed-status").textContent = message;
  };
  $("measure").onclick = () => {
    $("measure").disabled = true;
    $("speed-status").textContent = "Measuring…";
    const worker = new Worker(new URL("worker.js", import.meta.url), { type: "module" });
    worker.onerror = ({ message }) => end(worker, `The measurement failed: ${message}`);
    worker.onmessage = ({ data: { failed, scalar, batch } }) => {
      if (failed) return end(worker, `The measurement failed: ${failed}`);
      const millions = (rate) => `${(rate / 1e6).toFixed(1)} million`;
      $("scalar").textContent = millions(scalar);
      $("batch").textContent = millions(batch);
      $("ratio").textContent = (batch / scalar).toFixed(2);
      end(worker, "Each result is the best of ten runs.");
    };
    worker.postMessage({ module, task: "speed" });
  };
}
