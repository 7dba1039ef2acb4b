// The whole cloud is made on the graphics card: each vertex fetches its own stored value from the
// map, which lies there as a texture, so that the processor has nothing to do for a point.

export const vertexShader = `
precision highp float;
precision highp usampler2D;
uniform mat4 projectionMatrix, modelViewMatrix;
uniform usampler2D map;        // stored values, 0 where invalid
uniform sampler2D palette;     // from farthest to nearest
uniform sampler2D picture;
uniform int isDepth;           // stored values are depths, not disparities
uniform float scale, offset;   // stored * scale + offset is the disparity in px, or the depth in m
uniform float focal, baseline, principalOffset;
uniform vec2 center;           // principal point, px
uniform vec2 nearFar;          // stored values at the ends of the palette
uniform vec2 lowHigh;          // y in m at the ends of the palette: by height, which is -y
uniform int coloring;          // 0 depth, 1 height, 2 picture
uniform int step;              // every how many pixels, both ways
uniform float pointSize;       // px
out vec3 color;

void main() {
  ivec2 size = textureSize(map, 0);
  int columns = (size.x + step - 1) / step;
  ivec2 pixel = ivec2(gl_VertexID % columns, gl_VertexID / columns) * step;
  uint stored = texelFetch(map, pixel, 0).r;
  float value = float(stored) * scale + offset;
  float z = isDepth == 1 ? value : focal * baseline / (value + principalOffset);
  if (stored == 0u || !(z > 0.0 && z < 1e4)) {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // outside of what is seen
    gl_PointSize = 0.0;
    return;
  }
  vec3 point = vec3((vec2(pixel) - center) * z / focal, z);
  gl_Position = projectionMatrix * modelViewMatrix * vec4(point, 1.0);
  gl_PointSize = pointSize;
  if (coloring == 2) {
    color = texture(picture, (vec2(pixel) + 0.5) / vec2(size)).rgb;
  } else {
    float place = coloring == 0
        ? (float(stored) - nearFar.y) / (nearFar.x - nearFar.y)
        : (lowHigh.x - point.y) / (lowHigh.x - lowHigh.y);
    color = texture(palette, vec2(clamp(place, 0.0, 1.0) * 255.0 / 256.0 + 0.5 / 256.0, 0.5)).rgb;
  }
}`;

export const fragmentShader = `
precision highp float;
in vec3 color;
out vec4 fragment;
void main() { fragment = vec4(color, 1.0); }`;
