// How a body looks: distance as colour, contours at the thresholds, hatching where bodies overlap, grey beyond; or an
// amount on each face as colour, grey where there is none.
import { Color, ColorManagement, DataTexture, GLSL3, NearestFilter, RawShaderMaterial, Vector4 } from "three";
import { BEYOND, MARKED, MARKED_LATERAL, PLAIN, ramp } from "./colours.js";

ColorManagement.enabled = false; // colours go to the screen as the legend has them

const VERTEX = `
precision highp float;
uniform mat4 modelMatrix, viewMatrix, projectionMatrix;
uniform float first, stepSize;
in vec3 position, normal;
in float code;
out vec3 seen, placed;
out float value, beyond, level;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  placed = world.xyz;
  seen = mat3(viewMatrix) * mat3(modelMatrix) * normal;
  value = first + (code - 1.0) * stepSize;
  beyond = code > 254.5 ? 1.0 : 0.0;
  level = code;
  gl_Position = projectionMatrix * viewMatrix * world;
}`;

const FRAGMENT = `
precision highp float;
uniform sampler2D ramp;
uniform vec2 span;
uniform float thresholds[COUNT];
uniform vec4 section, plane;
uniform bool sectioned, coloured, amounts, sides, marked, divided;
uniform vec3 grey, plain, inside, one, other;
uniform float opacity, pixel, stepSize;
in vec3 seen, placed;
in float value, beyond, level;
out vec4 shown;

float line(float level, float slope, float width) {
  return 1.0 - smoothstep(width - 0.5, width + 0.5, abs(value - level) / slope / pixel);
}

void main() {
  float slope = max(fwidth(value), 1e-6);
  if (sectioned && dot(section.xyz, placed) > section.w) discard;
  if (sectioned && !gl_FrontFacing) { shown = vec4(inside, max(opacity, 0.6)); return; }
  vec3 normal = normalize(seen);
  normal = normal.z < 0.0 ? -normal : normal;
  float light = 0.62 + 0.42 * max(dot(normal, normalize(vec3(0.35, 0.5, 0.8))), 0.0);
  float shine = 0.10 * pow(max(dot(normal, normalize(vec3(0.2, 0.35, 1.0))), 0.0), 40.0);
  float solid = smoothstep(0.35, 0.75, opacity);
  vec3 colour = plain;
  if (coloured) {
    vec3 near = texture(ramp, vec2((value - span.x) / (span.y - span.x), 0.5)).rgb;
    if (!amounts && !sides && value < -2.0 * stepSize && mod(gl_FragCoord.x + gl_FragCoord.y, 7.0 * pixel) < 2.0 * pixel) near *= 0.45;
    float over = sides ? max(value - span.y, span.x - value) : value - span.y;
    float far = amounts ? 0.0 : smoothstep(-0.5, 0.5, over / slope / pixel);
    colour = mix(plain, mix(near, grey, max(smoothstep(0.0, 0.7, beyond), far)), solid);
  }
  if (marked && level < 128.0) colour = divided && dot(plane.xyz, placed) < plane.w ? other : one;
  colour = colour * light + shine;
  if (coloured && !amounts && beyond < 0.3) {
    for (int k = COUNT - 1; k >= 0; k--) {
      float wide = k == 0 ? 1.0 : 0.45;
      if (k == 0 && value < thresholds[k]) colour = mix(colour, vec3(1.0), 0.85 * solid * line(thresholds[k], slope, 2.2));
      colour = mix(colour, vec3(0.04), (k == 0 ? 1.0 : 0.75) * solid * line(thresholds[k], slope, wide));
    }
  }
  float rim = pow(1.0 - normal.z, 2.0);
  float alpha = opacity >= 0.99 ? 1.0 : mix(0.7 * opacity, min(1.0, 0.15 + 2.0 * opacity), rim);
  shown = vec4(colour, alpha);
}`;

/** Uniforms that all bodies share: colours, section plane, size of a pixel. */
export function sharedUniforms(scene) {
  return {
    ramp: { value: null },
    span: { value: scene.span },
    thresholds: { value: scene.thresholds },
    first: { value: 0 },
    stepSize: { value: 1 },
    amounts: { value: false },
    sides: { value: false },
    section: { value: new Vector4(1, 0, 0, 0) },
    sectioned: { value: false },
    pixel: { value: 1 },
    grey: { value: new Color(BEYOND) },
    plain: { value: new Color(PLAIN) },
  };
}

/** Let all bodies show a quantity. */
export function showQuantity(shared, quantity) {
  const colours = new DataTexture(ramp(quantity, 512), 512, 1);
  colours.magFilter = colours.minFilter = NearestFilter;
  colours.needsUpdate = true;
  shared.ramp.value?.dispose();
  shared.ramp.value = colours;
  shared.span.value = quantity.span;
  shared.first.value = quantity.first;
  shared.stepSize.value = quantity.step;
  shared.sides.value = quantity.sides;
  shared.amounts.value = quantity.map !== null;
}

/** Material of one body; `inside` is what a section shows of its interior. */
export function materialOf(shared, scene, inside) {
  return new RawShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    defines: { COUNT: scene.thresholds.length },
    uniforms: {
      ...shared,
      coloured: { value: false },
      inside: { value: new Color(inside) },
      opacity: { value: 1 },
      marked: { value: false },
      divided: { value: false },
      plane: { value: new Vector4(1, 0, 0, 0) },
      one: { value: new Color(MARKED) },
      other: { value: new Color(MARKED_LATERAL) },
    },
    side: 2,
  });
}
