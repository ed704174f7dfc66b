// Blinn–Phong in linear light: a headlight at the eye and directional lights. All vectors are unit, world space.

layout(constant_id = 7) const uint LIGHTS = 0;

vec3 blinn_phong(vec3 albedo, vec3 normal, vec3 light, vec3 view, float diffuse) {
    float lambert = dot(normal, light);
    if (lambert <= 0.0) return vec3(0.0);
    float highlight = pow(max(dot(normal, normalize(light + view)), 0.0), frame.shininess);
    return diffuse * lambert * albedo + frame.specular * highlight;
}

vec3 lit(vec3 albedo, vec3 normal, vec3 view) {
    vec3 sum = frame.ambient * albedo + blinn_phong(albedo, normal, view, view, frame.albedo.a);
    for (uint i = 0; i < LIGHTS; i++)
        sum += frame.radiance[i].rgb * blinn_phong(albedo, normal, frame.to_light[i].xyz, view, 1.0);
    return sum;
}
