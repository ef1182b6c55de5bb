// The files of runner/page/assets, and the schema of scenes.
#pragma once

namespace peclet::runner {

extern const char* const page_template;  // with @STYLE@, @SCRIPT@ and others where they go
extern const char* const page_style;
extern const char* const page_script;
extern const char* const scene_schema;  // JSON

}  // namespace peclet::runner
