// Blinn–Phong in linear light: a headlight at the eye and directional lights. All vectors are unit vectors in world space.

#ifndef LIB_SHADING
#define LIB_SHADING

layout(constant_id = 7) const uint LIGHTS = 0;

// Specular factor and exponent of Blinn–Phong.
struct Shine {
    vec3 specular;
    float shininess;
};

#define FRAME_SHINE Shine(vec3(frame.specular), frame.shininess)

vec3 blinn_phong(Shine shine, vec3 albedo, float lambert, float half_way, float diffuse) {
    if (lambert <= 0.0) return vec3(0.0);
    float highlight = pow(max(half_way, 0.0), shine.shininess);
    return diffuse * lambert * albedo + shine.specular * highlight;
}

// Lights a surface; `lambert` is the vector that gives diffuse light: the normal, or a mean of unit normals, shorter where these differ.
vec3 lit(Shine shine, vec3 albedo, vec3 normal, vec3 lambert, vec3 to_eye) {
    float facing = dot(normal, to_eye);
    vec3 sum = frame.ambient * albedo + blinn_phong(shine, albedo, dot(lambert, to_eye), facing, frame.albedo.a);
    for (uint i = 0; i < LIGHTS; i++) {
        vec3 light = view.to_light[i].xyz;
        float half_way = dot(normal, normalize(light + to_eye));
        sum += frame.radiance[i].rgb * blinn_phong(shine, albedo, dot(lambert, light), half_way, 1.0);
    }
    return sum;
}

// Of the normals of a line, the one nearest to a unit vector.
vec3 line_normal(vec3 tangent, vec3 towards) {
    vec3 normal = towards - dot(towards, tangent) * tangent;
    return dot(normal, normal) > 0.0 ? normalize(normal) : towards;
}

// Lights a line by its brightest normal for each light (marroquim2008 §4.2; highlights likewise).
vec3 lit_line(Shine shine, vec3 albedo, vec3 tangent, vec3 to_eye) {
    float facing = dot(line_normal(tangent, to_eye), to_eye);
    vec3 sum = frame.ambient * albedo + blinn_phong(shine, albedo, facing, facing, frame.albedo.a);
    for (uint i = 0; i < LIGHTS; i++) {
        vec3 light = view.to_light[i].xyz, middle = normalize(light + to_eye);
        float lambert = dot(line_normal(tangent, light), light), half_way = dot(line_normal(tangent, middle), middle);
        sum += frame.radiance[i].rgb * blinn_phong(shine, albedo, lambert, half_way, 1.0);
    }
    return sum;
}

#endif
