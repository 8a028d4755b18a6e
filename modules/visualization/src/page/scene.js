// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Draws the 3D view of a page; z is up. Points whose normal faces away from the viewer are not
// drawn, so that a room can be seen into from outside.
(() => {
  const vertexShader = `
    attribute vec3 color;
    attribute vec3 facing;
    uniform float size;
    uniform float viewHeight;
    varying vec3 shade;
    void main() {
      vec4 seen = modelViewMatrix * vec4(position, 1.0);
      bool hasNormal = dot(facing, facing) > 0.1;
      const vec3 light = vec3(0.30, 0.19, 0.93);
      shade = color * (hasNormal ? 0.82 + 0.18 * dot(facing, light) : 1.0);
      gl_Position = projectionMatrix * seen;
      gl_PointSize = max(1.5, size * viewHeight * projectionMatrix[1][1] / (2.0 * -seen.z));
      if (hasNormal && dot(facing, cameraPosition - position) < 0.0) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    }`;
  const fragmentShader = `
    varying vec3 shade;
    void main() { gl_FragColor = vec4(shade, 1.0); }`;

  const bytes = (base64) => Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));

  /// Coordinates are stored as fractions of the box, in 65535 steps.
  const unpack = (base64, box) => {
    const steps = new Uint16Array(bytes(base64).buffer);
    return Float32Array.from(steps, (step, i) =>
      box.min[i % 3] + (box.max[i % 3] - box.min[i % 3]) * step / 65535);
  };

  /// The box of all points except the outermost 1 % on each side.
  const boxOfMost = (places) => {
    const box = { min: new THREE.Vector3(), max: new THREE.Vector3() };
    for (const axis of [0, 1, 2]) {
      const sorted = places.filter((_, i) => i % 3 === axis).sort();
      box.min.setComponent(axis, sorted[Math.floor(0.01 * (sorted.length - 1))] ?? 0);
      box.max.setComponent(axis, sorted[Math.ceil(0.99 * (sorted.length - 1))] ?? 0);
    }
    return box;
  };

  const cloudOf = (cloud, data, size) => {
    const geometry = new THREE.BufferGeometry();
    const set = (name, array, normalized) =>
      geometry.setAttribute(name, new THREE.BufferAttribute(array, 3, normalized));
    set("position", unpack(cloud.points, data.box), false);
    set("facing", new Int8Array(bytes(cloud.normals).buffer), true);
    const colorings = cloud.colorings.map((base64) => bytes(base64));
    set("color", colorings[0], true);
    const material = new THREE.ShaderMaterial({
      vertexShader, fragmentShader, uniforms: { size: { value: size }, viewHeight: { value: 1 } } });
    const points = new THREE.Points(geometry, material);
    points.frustumCulled = false;
    return { points, paint: (i) => set("color", colorings[i], true) };
  };

  const pathOf = (path, data) => {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(unpack(path.points, data.box), 3));
    return new THREE.Line(geometry, new THREE.LineBasicMaterial({ color: path.color }));
  };

  const draw = (scene) => {
    const data = JSON.parse(scene.querySelector("script").textContent);
    const place = scene.querySelector(".canvas");
    let renderer;
    try {
      renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    } catch (error) {
      return;  // no WebGL: the text inside the element stays
    }
    place.replaceChildren(renderer.domElement);
    renderer.setPixelRatio(window.devicePixelRatio);
    renderer.setClearColor(0xffffff);

    const stage = new THREE.Scene();
    const clouds = data.clouds.map((cloud) => cloudOf(cloud, data, data.point_size_m));
    clouds.forEach((cloud) => stage.add(cloud.points));
    data.paths.forEach((path) => stage.add(pathOf(path, data)));
    const camera = new THREE.PerspectiveCamera(40, 1, 0.05, 1000);
    camera.up.set(0, 0, 1);
    const controls = new THREE.OrbitControls(camera, renderer.domElement);

    const render = () => renderer.render(stage, camera);
    const fit = () => {
      const width = place.clientWidth, height = place.clientHeight;
      renderer.setSize(width, height);
      camera.aspect = width / height;
      camera.updateProjectionMatrix();
      clouds.forEach((cloud) =>
        { cloud.points.material.uniforms.viewHeight.value = height * window.devicePixelRatio; });
      render();
    };
    const { min, max } = boxOfMost(clouds[0].points.geometry.attributes.position.array);
    const middle = min.clone().add(max).multiplyScalar(0.5);
    const lookFrom = (direction) => {
      const halfAngle = camera.fov / 2 * Math.PI / 180;
      const narrower = Math.atan(Math.tan(halfAngle) * Math.min(1, camera.aspect));
      const fill = 0.5 * max.distanceTo(min) / Math.sin(narrower);
      controls.target.copy(middle);
      camera.position.copy(middle).addScaledVector(direction.normalize(), 0.85 * fill);
      controls.update();
      render();
    };
    const views = {
      above: () => lookFrom(new THREE.Vector3(0, -1e-3, 1)),
      corner: () => lookFrom(new THREE.Vector3(-0.45, -0.62, 0.64)),
      side: () => lookFrom(new THREE.Vector3(0, -1, 0.15)),
    };
    controls.addEventListener("change", render);
    window.addEventListener("resize", fit);

    const chosen = (name) => Number(scene.querySelector(`input[name^=${name}]:checked`).value);
    const choose = () => {
      const shown = chosen("cloud"), coloring = chosen("coloring");
      clouds.forEach((cloud, i) => { cloud.points.visible = i === shown; cloud.paint(coloring); });
      scene.querySelectorAll(".legend").forEach((legend, i) => { legend.hidden = i !== coloring; });
      render();
    };
    scene.querySelectorAll("input[type=radio]").forEach((input) =>
      input.addEventListener("change", choose));
    scene.querySelectorAll("button[data-view]").forEach((button) =>
      button.addEventListener("click", () => views[button.dataset.view]()));
    scene.querySelectorAll(".controls").forEach((bar) => { bar.hidden = false; });
    fit();
    choose();
    views.corner();
  };

  document.querySelectorAll(".scene").forEach(draw);
})();
