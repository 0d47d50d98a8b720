// What is uncertain, and what the sweep shows, at the sensor.
import { Matrix4, Mesh, MeshBasicMaterial, SphereGeometry, WireframeGeometry, LineBasicMaterial, LineSegments } from 'three';
import { colour, onTheme } from './theme.js';

export const EXAGGERATION = 300;
const EVIDENCE_RADIUS_M = 2.2;

/// Lower triangle L with L·Lᵀ = A of a symmetric matrix [xx xy xz yy yz zz]: it makes the ellipsoid out of a sphere.
export function factor([xx, xy, xz, yy, yz, zz]) {
  const root = (value) => Math.sqrt(Math.max(value, 1e-12));
  const a = root(xx);
  const b = xy / a;
  const c = xz / a;
  const d = root(yy - b * b);
  const e = (yz - b * c) / d;
  return [a, b, c, d, e, root(zz - c * c - e * e)];
}

function shape(mesh, symmetric, size) {
  const [a, b, c, d, e, f] = factor(symmetric).map((value) => size * value);
  mesh.matrix.copy(new Matrix4().set(a, 0, 0, 0, b, d, 0, 0, c, e, f, 0, 0, 0, 0, 1));
}

export class Ellipsoids {
  constructor(stage) {
    this.stage = stage;
    const sphere = new SphereGeometry(1, 24, 16);
    this.covariance = new Mesh(sphere, new MeshBasicMaterial({ transparent: true, opacity: 0.45, depthWrite: false }));
    this.evidence = new LineSegments(new WireframeGeometry(new SphereGeometry(1, 14, 8)),
      new LineBasicMaterial({ transparent: true, opacity: 0.5 }));
    for (const mesh of [this.covariance, this.evidence]) {
      mesh.matrixAutoUpdate = false;
      mesh.frustumCulled = false;
      mesh.visible = false;
      mesh.wanted = true;
      stage.sensor.add(mesh);
    }
    onTheme(() => {
      this.covariance.material.color.set(colour('estimate'));
      this.evidence.material.color.set(colour('text'));
      stage.dirty = true;
    });
  }

  show(record) {
    this.covariance.visible = this.covariance.wanted && record.covariance[0] > 0;
    this.evidence.visible = this.evidence.wanted && record.evidence.some((value) => value > 0);
    // Guesses (lost, empty) have metres: at most as large as the rings.
    const largest = Math.sqrt(Math.max(record.covariance[0], record.covariance[3], record.covariance[5], 1e-12));
    shape(this.covariance, record.covariance, Math.min(EXAGGERATION, 12 / largest));
    shape(this.evidence, record.evidence, EVIDENCE_RADIUS_M);
    this.stage.dirty = true;
  }
}
