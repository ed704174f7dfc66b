struct View {
    world_to_clip: mat4x4f,
    to_light: vec4f,
}

struct Corner {
    @builtin(position) position: vec4f,
    @location(0) normal: vec3f,
}

@group(0) @binding(0) var<uniform> view: View;

@vertex
fn corner(@location(0) position: vec3f, @location(1) normal: vec3f) -> Corner {
    return Corner(view.world_to_clip * vec4f(position, 1.0), normal);
}

@vertex
fn place(@location(0) position: vec3f) -> @builtin(position) vec4f {
    return view.world_to_clip * vec4f(position, 1.0);
}

@fragment
fn lit(@location(0) normal: vec3f) -> @location(0) vec4f {
    let light = 0.15 + 0.85 * max(dot(normalize(normal), view.to_light.xyz), 0.0);
    return vec4f(light * vec3f(0.15, 0.35, 0.8), 1.0);
}

// Colour times α.
@fragment
fn glass() -> @location(0) vec4f {
    return vec4f(0.08, 0.25, 0.12, 0.4);
}
