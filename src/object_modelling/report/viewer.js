// Shows the model in #viewer; sets its data-state and data-triangles to the outcome.
(function () {
  "use strict";
  var box = document.getElementById("viewer");
  var note = document.getElementById("viewer-note");

  function fail(reason) {
    box.setAttribute("data-state", "failed");
    note.textContent = "No 3-D view: " + reason;
  }

  function bytesOf(id) {
    var text = atob(document.getElementById(id).textContent.trim());
    var bytes = new Uint8Array(text.length);
    for (var i = 0; i < text.length; ++i)
      bytes[i] = text.charCodeAt(i);
    return bytes.buffer;
  }

  function trianglesOf(object) {
    var count = 0;
    object.traverse(function (part) {
      if (part.isMesh)
        count += (part.geometry.index || part.geometry.attributes.position).count / 3;
    });
    return count;
  }

  function sharpen(object, anisotropy) {
    object.traverse(function (part) {
      if (part.isMesh && part.material.map)
        part.material.map.anisotropy = anisotropy;
    });
  }

  function cameraPath(cameras) {
    var group = new THREE.Group();
    cameras.forEach(function (camera) {
      var ball = new THREE.Mesh(new THREE.SphereBufferGeometry(0.006, 12, 8),
                                new THREE.MeshBasicMaterial({ color: camera.colour }));
      ball.position.fromArray(camera.position);
      group.add(ball);
    });
    group.visible = false;
    return group;
  }

  function show(gltf, renderer) {
    var scene = new THREE.Scene();
    scene.background = new THREE.Color(0xffffff);
    scene.add(gltf.scene);
    sharpen(gltf.scene, renderer.capabilities.getMaxAnisotropy());
    var cameras = cameraPath(JSON.parse(box.getAttribute("data-cameras")));
    scene.add(cameras);

    var sphere = new THREE.Box3().setFromObject(gltf.scene).getBoundingSphere(new THREE.Sphere());
    var camera = new THREE.PerspectiveCamera(30, box.clientWidth / box.clientHeight, sphere.radius / 50,
                                             sphere.radius * 200);
    camera.up.set(0, 0, 1);
    scene.add(camera);
    scene.add(new THREE.AmbientLight(0xffffff, 0.7));
    var lamp = new THREE.DirectionalLight(0xffffff, 0.4);
    camera.add(lamp);
    camera.add(lamp.target);
    lamp.target.position.set(0, 0, -1);

    var controls = new THREE.OrbitControls(camera, renderer.domElement);
    controls.target.copy(sphere.center);

    function look(distance) {
      camera.position.set(0.75, -0.55, 0.42).normalize().multiplyScalar(distance).add(sphere.center);
      controls.update();
    }
    function draw() { renderer.render(scene, camera); }
    function fit() {
      camera.aspect = box.clientWidth / box.clientHeight;
      camera.updateProjectionMatrix();
      renderer.setSize(box.clientWidth, box.clientHeight);
      draw();
    }
    controls.addEventListener("change", draw);
    window.addEventListener("resize", fit);
    document.getElementById("show-cameras").addEventListener("change", function (event) {
      cameras.visible = event.target.checked;
      var reach = new THREE.Box3().setFromObject(cameras).getBoundingSphere(new THREE.Sphere());
      look(cameras.visible ? 4.2 * Math.max(reach.radius, sphere.radius) : 4.2 * sphere.radius);
      draw();
    });
    look(4.2 * sphere.radius);
    fit();
    box.setAttribute("data-triangles", String(trianglesOf(gltf.scene)));
    box.setAttribute("data-state", "loaded");
  }

  var renderer;
  try {
    // WebGL 2 where there is one: it takes textures of any size as they are.
    var canvas = document.createElement("canvas");
    var settings = { antialias: true, preserveDrawingBuffer: true };
    renderer = new THREE.WebGLRenderer({ canvas: canvas, context: canvas.getContext("webgl2", settings) ||
                                                                  canvas.getContext("webgl", settings) });
  } catch (error) {
    fail("this browser has no WebGL");
    return;
  }
  renderer.gammaOutput = true;
  renderer.gammaFactor = 2.2;
  renderer.setPixelRatio(window.devicePixelRatio);
  box.appendChild(renderer.domElement);
  new THREE.GLTFLoader().parse(bytesOf("model-glb"), "", function (gltf) { show(gltf, renderer); },
                               function (error) { fail(error.message || "the model cannot be read"); });
})();
