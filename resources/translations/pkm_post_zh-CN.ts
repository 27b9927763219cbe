<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="zh_CN" sourcelanguage="en">
<context>
    <name>App::Property</name>
    <message>
        <source>The operation that this one is made from</source>
        <translation>本操作由此操作生成</translation>
    </message>
    <message>
        <source>Switch this off to leave the operation out of the program</source>
        <translation>关闭后，程序中不包含此操作</translation>
    </message>
    <message>
        <source>Name of a machine that comes with PKM Post, or path of a machine file</source>
        <translation>PKM Post 自带机床的名称，或机床文件的路径</translation>
    </message>
    <message>
        <source>CAM job that supplies the work offset</source>
        <translation>从此 CAM 作业取得工件偏置</translation>
    </message>
    <message>
        <source>Object of the model that the work offset places, if there is no job; the origin of the document if there is none</source>
        <translation>没有作业时，由工件偏置定位的模型对象；若也没有该对象，则为文档原点</translation>
    </message>
    <message>
        <source>Pose of the work frame on the table, in the machine frame</source>
        <translation>工件坐标系在工作台上的位姿，以机床坐标系表示</translation>
    </message>
    <message>
        <source>Tool tip in the work frame</source>
        <translation>刀尖在工件坐标系中的位置</translation>
    </message>
    <message>
        <source>From the tip towards the spindle, in the work frame</source>
        <translation>从刀尖指向主轴的方向，以工件坐标系表示</translation>
    </message>
    <message>
        <source>Turn of the platform about the tool axis</source>
        <translation>动平台绕刀轴的转角</translation>
    </message>
    <message>
        <source>Gauge length, from the spindle nose to the tip</source>
        <translation>刀具长度，从主轴端面到刀尖</translation>
    </message>
    <message>
        <source>Diameter of the cutter that is drawn</source>
        <translation>所显示刀具的直径</translation>
    </message>
    <message>
        <source>Its corner radius: half the diameter for a ball</source>
        <translation>刀具圆角半径：球头刀为直径的一半</translation>
    </message>
    <message>
        <source>Length that the controller counts</source>
        <translation>控制器计数的杆长</translation>
    </message>
    <message>
        <source>Smallest margin of a strut to an end of its stroke</source>
        <translation>最接近行程端点的支链的剩余行程</translation>
    </message>
    <message>
        <source>Smallest margin of a joint to its cone</source>
        <translation>最接近锥角极限的铰链的剩余摆角</translation>
    </message>
    <message>
        <source>Smallest singular value above the least allowed</source>
        <translation>最小奇异值超出允许下限的量</translation>
    </message>
    <message>
        <source>Limits that are violated at this pose</source>
        <translation>此位姿下超出极限的项目</translation>
    </message>
    <message>
        <source>Where the machine frame is in the document</source>
        <translation>机床坐标系在文档中的位置</translation>
    </message>
    <message>
        <source>The model of the job, whose faces are touched</source>
        <translation>作业的模型，刀具与其面接触</translation>
    </message>
    <message>
        <source>The faces that may be touched; all of the model if empty</source>
        <translation>允许接触的面；为空时为模型的所有面</translation>
    </message>
    <message>
        <source>Largest distance of a point from the face it touches</source>
        <translation>接触点与所接触的面之间允许的最大距离</translation>
    </message>
    <message>
        <source>Largest deviation of the tool from the surface between two points</source>
        <translation>两点之间刀具允许的最大偏差</translation>
    </message>
    <message>
        <source>Stock left on the faces, along the normal</source>
        <translation>沿法向留在面上的余量</translation>
    </message>
    <message>
        <source>Length of feed moves off the faces before and after a cut</source>
        <translation>切削前后离开面的进给移动的长度</translation>
    </message>
    <message>
        <source>Where the tool axis comes from</source>
        <translation>刀轴方向的来源</translation>
    </message>
    <message>
        <source>Lean from the normal forward, in the direction of feed</source>
        <translation>刀轴相对法线沿进给方向的前倾角</translation>
    </message>
    <message>
        <source>Lean from the normal to the left of the direction of feed</source>
        <translation>刀轴相对法线向进给方向左侧的侧倾角</translation>
    </message>
    <message>
        <source>The part program, G-code or CL data</source>
        <translation>零件程序，G 代码或刀位文件</translation>
    </message>
    <message>
        <source>Notation of the tool axis in G-code</source>
        <translation>G 代码中刀轴的表示方式</translation>
    </message>
    <message>
        <source>Dialect of the G-code</source>
        <translation>零件程序所用 G 代码的方言</translation>
    </message>
    <message>
        <source>The unit of dwells of G-code</source>
        <translation>G 代码中暂停时间的单位</translation>
    </message>
    <message>
        <source>Position of the tool tip in mm at G53 X0 Y0 Z0, G28 and G30</source>
        <translation>G53 X0 Y0 Z0、G28 和 G30 使刀尖到达的 X、Y、Z（mm）</translation>
    </message>
    <message>
        <source>Unknown codes of G-code to skip, such as M21</source>
        <translation>不认识时略去的 G 代码，例如 M21</translation>
    </message>
    <message>
        <source>Origins of work offsets of G-code, as in G55=100,0,0 with mm and degrees</source>
        <translation>G 代码工件偏置的原点,例如 G55=100,0,0,单位为毫米和度</translation>
    </message>
    <message>
        <source>Folders searched for subprogram files before that of the part program</source>
        <translation>子程序文件所在的文件夹,先于零件程序的文件夹查找</translation>
    </message>
    <message>
        <source>Skip what follows a / in blocks of G-code</source>
        <translation>是否略去 G 代码程序段中 / 之后的内容</translation>
    </message>
    <message>
        <source>Switches of block delete that are on, as 2 for /2; none: as BlockDelete</source>
        <translation>接通的跳段开关,如 2 表示 /2;空则按 BlockDelete</translation>
    </message>
    <message>
        <source>Feed of cutting moves before the first one of the file, mm/min; 0 for none</source>
        <translation>文件给出第一个进给之前切削移动的进给,毫米/分钟;0 表示没有</translation>
    </message>
    <message>
        <source>Meanings of the values of GOTO statements of CL data, as in x,y,z,i,j,k</source>
        <translation>CL 数据 GOTO 语句中各数值的含义,例如 x,y,z,i,j,k</translation>
    </message>
    <message>
        <source>File with the tools of the part program, as in tools.tbl,mm</source>
        <translation>零件程序的刀具文件,例如 tools.tbl,mm</translation>
    </message>
    <message>
        <source>Strokes of kinds of CYCLE statements of CL data, as in BORE=ream,DEEPHL=deep</source>
        <translation>CL 数据 CYCLE 语句各类型的动作,例如 BORE=ream,DEEPHL=deep</translation>
    </message>
    <message>
        <source>Unit of length of the part program</source>
        <translation>零件程序的长度单位</translation>
    </message>
    <message>
        <source>Meaning of the points of CL data under CUTCOM: tool centre or part contour</source>
        <translation>刀位文件中 CUTCOM 下的点是刀具中心还是零件轮廓</translation>
    </message>
    <message>
        <source>The CAM system that wrote the CL data</source>
        <translation>生成刀位文件的 CAM 系统</translation>
    </message>
    <message>
        <source>Meanings of the numbers without words in a CYCLE statement</source>
        <translation>CYCLE 语句中没有关键字的数值的含义</translation>
    </message>
    <message>
        <source>Whether the part program may have no end, such as M2 or FINI</source>
        <translation>零件程序是否可以没有结束语句（如 M2 或 FINI）</translation>
    </message>
    <message>
        <source>Diagnostics from reading the file</source>
        <translation>读取文件时发现的问题</translation>
    </message>
    <message>
        <source>The CAM job that is checked</source>
        <translation>被检查的 CAM 作业</translation>
    </message>
    <message>
        <source>The machine in the document; that of the job&apos;s arguments if there is none</source>
        <translation>文档中的机床；没有时取作业参数中的机床</translation>
    </message>
    <message>
        <source>Switch this off to stop checking when the job changes</source>
        <translation>关闭后，作业更改时不再检查</translation>
    </message>
    <message>
        <source>The check whose margins colour the path</source>
        <translation>按此检查项为轨迹着色</translation>
    </message>
    <message>
        <source>Whether the machine can follow; where it is slower, it can</source>
        <translation>机床能否跟随；仅是速度较慢时视为能够跟随</translation>
    </message>
    <message>
        <source>The checks; the lists below have an entry for each</source>
        <translation>检查项；下面的列表与其逐项对应</translation>
    </message>
    <message>
        <source>Of the margins</source>
        <translation>余量的单位</translation>
    </message>
    <message>
        <source>Least margin; negative is out of limits</source>
        <translation>最小余量；负值表示超出极限</translation>
    </message>
    <message>
        <source>Margins proven between the points as well</source>
        <translation>点与点之间也已证明的余量</translation>
    </message>
    <message>
        <source>Part of the machine with the smallest margin</source>
        <translation>余量最小的部件</translation>
    </message>
    <message>
        <source>Operation in which that is</source>
        <translation>其所在的操作</translation>
    </message>
    <message>
        <source>Number of the command in the operation</source>
        <translation>操作中命令的序号</translation>
    </message>
    <message>
        <source>Where the tool tip is then</source>
        <translation>此时刀尖的位置</translation>
    </message>
    <message>
        <source>Operation of each violation</source>
        <translation>每个越限所在的操作</translation>
    </message>
    <message>
        <source>Violated limits and collisions, the worst of each operation</source>
        <translation>越限与碰撞，每个操作中最严重的</translation>
    </message>
    <message>
        <source>The report as text</source>
        <translation>供阅读的报告</translation>
    </message>
    <message>
        <source>The path of the tool tip</source>
        <translation>刀尖轨迹</translation>
    </message>
    <message>
        <source>Margin at each point, of the check that it is coloured by</source>
        <translation>着色所用检查项在每一点的余量</translation>
    </message>
    <message>
        <source>The CAM job that is simulated</source>
        <translation>被仿真的 CAM 作业</translation>
    </message>
    <message>
        <source>Switch this off to stop planning when the job changes</source>
        <translation>关闭后，作业更改时不再规划</translation>
    </message>
    <message>
        <source>Time in which the struts move</source>
        <translation>支链运动的时间</translation>
    </message>
    <message>
        <source>Additional time of dwells; stops and tool changes do not count</source>
        <translation>此外程序等待的时间；停止和换刀不计入</translation>
    </message>
    <message>
        <source>Motions of the program</source>
        <translation>程序的运动段数</translation>
    </message>
    <message>
        <source>Knots in time that the controller would get</source>
        <translation>控制器将得到的时间节点数</translation>
    </message>
    <message>
        <source>Length of the path of the tool tip, with rapid moves</source>
        <translation>刀尖轨迹的长度，包括快速移动</translation>
    </message>
    <message>
        <source>Least length that a strut has</source>
        <translation>支链的最小杆长</translation>
    </message>
    <message>
        <source>Greatest length that a strut has</source>
        <translation>支链的最大杆长</translation>
    </message>
    <message>
        <source>Greatest speed of a strut, in either direction</source>
        <translation>支链的最大速度，不分方向</translation>
    </message>
    <message>
        <source>Number of the strut that has it</source>
        <translation>达到该速度的支链编号</translation>
    </message>
    <message>
        <source>The operations; the list below has an entry for each</source>
        <translation>各操作；下面的列表与其逐项对应</translation>
    </message>
    <message>
        <source>Duration of each with its dwells, in s</source>
        <translation>每个操作的用时，包括暂停，单位 s</translation>
    </message>
    <message>
        <source>Their number; the first 1000 are in the lists</source>
        <translation>问题的数量；列表中为前 1000 个</translation>
    </message>
    <message>
        <source>Start of each, in s</source>
        <translation>每个问题开始的时刻，单位 s</translation>
    </message>
    <message>
        <source>Worst moment of each, in s</source>
        <translation>每个问题最严重的时刻，单位 s</translation>
    </message>
    <message>
        <source>Stretches that the machine cannot follow, by time</source>
        <translation>机床不能跟随之处，按时间排列</translation>
    </message>
    <message>
        <source>Lines that the passes follow</source>
        <translation>走刀所沿的方向</translation>
    </message>
    <message>
        <source>Order of the passes</source>
        <translation>各次走刀的先后方式</translation>
    </message>
    <message>
        <source>Normal of the parallel planes</source>
        <translation>平行平面的法线</translation>
    </message>
    <message>
        <source>Begin at the other side of the face</source>
        <translation>从面的另一侧开始</translation>
    </message>
    <message>
        <source>Where the material is; in a zigzag on its first pass</source>
        <translation>材料所在的一侧；往复走刀时以第一次走刀为准</translation>
    </message>
    <message>
        <source>The material is on the other side of the faces</source>
        <translation>材料在面的另一侧</translation>
    </message>
    <message>
        <source>Whether distance or scallop height sets the stepover</source>
        <translation>行距的确定方式</translation>
    </message>
    <message>
        <source>Largest distance of passes along the surface</source>
        <translation>沿曲面的最大行距</translation>
    </message>
    <message>
        <source>Largest scallop height between passes</source>
        <translation>两次走刀之间的最大残留高度</translation>
    </message>
    <message>
        <source>Largest deviation of the cutter from the surface on straight moves</source>
        <translation>直线移动时刀具偏离曲面的最大允许量</translation>
    </message>
    <message>
        <source>Largest deviation of the tool axis between two points</source>
        <translation>两点之间刀轴允许的最大偏差</translation>
    </message>
    <message>
        <source>Middle of the cone in which the tool axis stays</source>
        <translation>限制刀轴的圆锥的轴线</translation>
    </message>
    <message>
        <source>Half angle of that cone; 180 degrees for no limit</source>
        <translation>该圆锥的半角；180 度表示无限制</translation>
    </message>
    <message>
        <source>Name or file of a machine whose reach limits the tilt from upright</source>
        <translation>机床的名称或文件，其可达性限制刀轴相对竖直方向的倾角</translation>
    </message>
    <message>
        <source>Where rapid motion ends, along the tool axis</source>
        <translation>快速移动结束处沿刀轴的距离</translation>
    </message>
    <message>
        <source>Form of lead-in and lead-out</source>
        <translation>刀具进入和离开曲面的方式</translation>
    </message>
    <message>
        <source>Length of a straight lead, radius of an arc</source>
        <translation>直线进退刀的长度，或圆弧进退刀的半径</translation>
    </message>
    <message>
        <source>Distance of the points of the model at which gouges and material left are measured; 0 to measure nothing</source>
        <translation>模型上测量过切和残留材料的点的间距；0 表示不测量</translation>
    </message>
    <message>
        <source>Number of passes</source>
        <translation>走刀次数</translation>
    </message>
    <message>
        <source>Points at which the tool axis was moved into its cone</source>
        <translation>刀轴被移入圆锥内的点数</translation>
    </message>
    <message>
        <source>Deepest cut into the model that was found, mm; -1 if not measured</source>
        <translation>测得的切入模型的最大深度，毫米；-1 表示未测量</translation>
    </message>
    <message>
        <source>Largest possible further depth between the points, mm; -1 if not measured</source>
        <translation>检查点之间的过切最多还可能深多少，毫米；-1 表示未测量</translation>
    </message>
    <message>
        <source>Where that is</source>
        <translation>其位置</translation>
    </message>
    <message>
        <source>Most material left found at points CheckSpacing apart, mm; more between them may be missed; -1 if not measured</source>
        <translation>在间距为 CheckSpacing 的各点上测得的最多残留材料，mm；点与点之间可能更多而未被发现；未测量时为 -1</translation>
    </message>
    <message>
        <source>Half angle of the cone that was used, limited by the machine</source>
        <translation>考虑机床允许范围后圆锥的半角</translation>
    </message>
    <message>
        <source>Side of the material along the path of the original, where its properties do not state it</source>
        <translation>沿原操作的走刀方向看材料所在的一侧，用于原操作未说明时</translation>
    </message>
    <message>
        <source>A point of the plane of the mirror</source>
        <translation>镜像平面上的一点</translation>
    </message>
    <message>
        <source>Normal of the plane of the mirror</source>
        <translation>镜像平面的法线</translation>
    </message>
    <message>
        <source>A flat face or datum plane that defines point and normal</source>
        <translation>给出点和法线的平面或基准平面</translation>
    </message>
    <message>
        <source>Reverse each pass, to keep climb milling</source>
        <translation>每次走刀反向，使顺铣保持为顺铣</translation>
    </message>
    <message>
        <source>A point of the axis</source>
        <translation>轴线上的一点</translation>
    </message>
    <message>
        <source>Direction of the axis</source>
        <translation>轴线的方向</translation>
    </message>
    <message>
        <source>An edge, round face or datum line that defines point and direction</source>
        <translation>给出点和方向的边、回转面或基准线</translation>
    </message>
    <message>
        <source>Angle of rotation, right-handed about the axis</source>
        <translation>旋转角度，绕轴线按右手法则</translation>
    </message>
    <message>
        <source>Number of copies, each rotated by Angle from the one before</source>
        <translation>副本数，每个副本相对前一个旋转一个“Angle”</translation>
    </message>
    <message>
        <source>Angles of the copies in degrees, instead of the two</source>
        <translation>各副本的角度，单位度，代替以上两项</translation>
    </message>
    <message>
        <source>Cut direction of the original: Climb, Conventional, Both or Unknown</source>
        <translation>原操作的铣削方式：Climb（顺铣）、Conventional（逆铣）、Both（两者）或 Unknown（未知）</translation>
    </message>
    <message>
        <source>Cut direction of the copies</source>
        <translation>副本的铣削方式</translation>
    </message>
    <message>
        <source>Number of places where the original and its copies meet</source>
        <translation>原操作与副本相接的处数</translation>
    </message>
    <message>
        <source>Largest distance of the tips where they meet</source>
        <translation>相接处刀尖的最大距离</translation>
    </message>
    <message>
        <source>Largest angle of the tool axes where they meet</source>
        <translation>相接处刀轴的最大夹角</translation>
    </message>
    <message>
        <source>Number of reversed passes</source>
        <translation>反向走刀的次数</translation>
    </message>
    <message>
        <source>Number of arcs with reversed sense, G2 for G3 or G3 for G2</source>
        <translation>反向的圆弧数，G2 变为 G3 或 G3 变为 G2</translation>
    </message>
    <message>
        <source>Distance between the cuts of the original and of the copy</source>
        <translation>原操作与副本切削区域之间的距离</translation>
    </message>
    <message>
        <source>Width in which the original and the copy both cut</source>
        <translation>原操作与副本都切削的宽度</translation>
    </message>
    <message>
        <source>Angle in which the original and its copies cut</source>
        <translation>原操作与副本切削的角度范围</translation>
    </message>
    <message>
        <source>Angle in which two of them or more cut</source>
        <translation>两个或更多重复切削的角度范围</translation>
    </message>
    <message>
        <source>Widest angle in which none of them cuts</source>
        <translation>均未切削的最大角度范围</translation>
    </message>
    <message>
        <source>Whether they cover the full circle without overlap</source>
        <translation>是否布满整周且互不重叠</translation>
    </message>
    <message>
        <source>Distance from the spindle nose to the tip of the tool</source>
        <translation>从主轴端面到刀尖的距离</translation>
    </message>
</context>
<context>
    <name>ContextMenu</name>
    <message>
        <source>Active</source>
        <translation>启用</translation>
    </message>
    <message>
        <source>Switch on or off</source>
        <translation>启用或停用</translation>
    </message>
</context>
<context>
    <name>ControlPanel</name>
    <message>
        <source>Gauge length of the tool in the spindle</source>
        <translation>主轴中刀具的长度，从主轴端面到刀尖</translation>
    </message>
    <message>
        <source>Connect</source>
        <translation>连接</translation>
    </message>
    <message>
        <source>Connect to the machine</source>
        <translation>连接机床</translation>
    </message>
    <message>
        <source>Simulated machine</source>
        <translation>模拟机床</translation>
    </message>
    <message>
        <source>Operate a simulated machine for training; nothing real moves</source>
        <translation>操作模拟机床，供练习；没有真实部件运动</translation>
    </message>
    <message>
        <source>Disconnect</source>
        <translation>断开</translation>
    </message>
    <message>
        <source>Disconnect; the controller continues</source>
        <translation>结束连接；控制器继续执行正在进行的动作</translation>
    </message>
    <message>
        <source>Port</source>
        <translation>端口</translation>
    </message>
    <message>
        <source>Machine</source>
        <translation>机床</translation>
    </message>
    <message>
        <source>Tool length</source>
        <translation>刀具长度</translation>
    </message>
    <message>
        <source>The tool length must be above zero</source>
        <translation>刀具长度必须大于零</translation>
    </message>
    <message>
        <source>Machine file</source>
        <translation>机床文件</translation>
    </message>
    <message>
        <source>Machine files</source>
        <translation>机床文件</translation>
    </message>
    <message>
        <source>Program {}: {} lines, listed back as sent</source>
        <translation>程序 {}：{} 行，回读与发送内容一致</translation>
    </message>
    <message>
        <source>An internal error ended the connection. THE MACHINE CONTINUES.</source>
        <translation>本软件出错，连接已中断。机床仍在继续运行。</translation>
    </message>
    <message>
        <source>Not executed: a stop came first</source>
        <translation>未执行：已先发出停止指令</translation>
    </message>
    <message>
        <source>Numerical control</source>
        <translation>数控面板</translation>
    </message>
    <message>
        <source>The machine moves, or may move. Hold it, or let it continue?</source>
        <translation>机床正在运动或可能运动。如何处理？</translation>
    </message>
    <message>
        <source>Hold it, then close</source>
        <translation>进给保持，然后关闭</translation>
    </message>
    <message>
        <source>Close; the machine continues</source>
        <translation>关闭；机床继续运行</translation>
    </message>
    <message>
        <source>The machine of the document follows</source>
        <translation>文档中的机床跟随运动</translation>
    </message>
    <message>
        <source>Connection</source>
        <translation>连接</translation>
    </message>
    <message>
        <source>Homing</source>
        <translation>回零</translation>
    </message>
    <message>
        <source>Jog</source>
        <translation>点动</translation>
    </message>
    <message>
        <source>MDI</source>
        <translation>MDI</translation>
    </message>
    <message>
        <source>Program</source>
        <translation>程序</translation>
    </message>
    <message>
        <source>Play</source>
        <translation>播放</translation>
    </message>
    <message>
        <source>Struts</source>
        <translation>支链</translation>
    </message>
    <message>
        <source>Not connected</source>
        <translation>未连接</translation>
    </message>
    <message>
        <source>No link: {}</source>
        <translation>无连接：{}</translation>
    </message>
    <message>
        <source>Please wait: connecting, disconnecting or reading</source>
        <translation>请稍候：正在连接、断开或读取</translation>
    </message>
    <message>
        <source>SIMULATED MACHINE: for training. Nothing real moves.</source>
        <translation>模拟机床：仅供练习。没有真实部件运动。</translation>
    </message>
    <message>
        <source>The active document has no machine object of this machine that is free</source>
        <translation>活动文档中没有空闲的该机床对象</translation>
    </message>
    <message>
        <source>Home</source>
        <translation>回零</translation>
    </message>
    <message>
        <source>Start the homing of the machine, and watch it</source>
        <translation>启动机床回零，并监视其过程</translation>
    </message>
    <message>
        <source>Line that starts the homing of this machine, as specified by its builder, such as ENABLE PLC 3</source>
        <translation>启动本机床回零的命令行，由机床制造商给出，例如 ENABLE PLC 3</translation>
    </message>
    <message>
        <source>The machine moves by itself now, and Hold does not stop it: have the emergency stop at hand.
Is the way of all struts, of the platform and of the tool free?</source>
        <translation>机床即将自行运动，“进给保持”不能使其停止：请将手放在急停按钮旁。
所有支链、动平台和刀具的运动路径是否畅通无阻？</translation>
    </message>
    <message>
        <source>Home the machine</source>
        <translation>机床回零</translation>
    </message>
    <message>
        <source>X</source>
        <translation>X</translation>
    </message>
    <message>
        <source>The tip along X of the machine</source>
        <translation>刀尖沿机床 X 轴移动</translation>
    </message>
    <message>
        <source>Y</source>
        <translation>Y</translation>
    </message>
    <message>
        <source>The tip along Y of the machine</source>
        <translation>刀尖沿机床 Y 轴移动</translation>
    </message>
    <message>
        <source>Z</source>
        <translation>Z</translation>
    </message>
    <message>
        <source>The tip along Z of the machine</source>
        <translation>刀尖沿机床 Z 轴移动</translation>
    </message>
    <message>
        <source>Tilt X</source>
        <translation>绕 X 倾斜</translation>
    </message>
    <message>
        <source>Tilt of the tool axis about X of the machine; the tip stays</source>
        <translation>刀轴绕机床 X 轴转动；刀尖不动</translation>
    </message>
    <message>
        <source>Tilt Y</source>
        <translation>绕 Y 倾斜</translation>
    </message>
    <message>
        <source>Tilt of the tool axis about Y of the machine; the tip stays</source>
        <translation>刀轴绕机床 Y 轴转动；刀尖不动</translation>
    </message>
    <message>
        <source>Spin</source>
        <translation>自转角</translation>
    </message>
    <message>
        <source>Rotation of the platform about the tool axis; the tip stays</source>
        <translation>动平台绕刀轴转动；刀尖不动</translation>
    </message>
    <message>
        <source>Step</source>
        <translation>步长</translation>
    </message>
    <message>
        <source>Turn</source>
        <translation>转角</translation>
    </message>
    <message>
        <source>Speed</source>
        <translation>速度</translation>
    </message>
    <message>
        <source>Turning</source>
        <translation>转速</translation>
    </message>
    <message>
        <source>Strut</source>
        <translation>支链</translation>
    </message>
    <message>
        <source>One strut alone; the platform moves with it</source>
        <translation>仅一条支链；动平台随之运动</translation>
    </message>
    <message>
        <source>Not sent: the speed must be above zero</source>
        <translation>未发送：速度必须大于零</translation>
    </message>
    <message>
        <source>Not sent: the jog is refused</source>
        <translation>未发送：点动被拒绝</translation>
    </message>
    <message>
        <source>Tool axis words of the line; none keeps the axis</source>
        <translation>该行中刀轴的表示方式；none 表示保持不变</translation>
    </message>
    <message>
        <source>Check</source>
        <translation>检查</translation>
    </message>
    <message>
        <source>Plan the line, and send nothing</source>
        <translation>规划该行，不发送任何内容</translation>
    </message>
    <message>
        <source>Run</source>
        <translation>执行</translation>
    </message>
    <message>
        <source>Plan the line and, if it passes all checks, execute it</source>
        <translation>规划该行，如无问题则执行</translation>
    </message>
    <message>
        <source>Refused; nothing was sent</source>
        <translation>已拒绝；未发送任何内容</translation>
    </message>
    <message>
        <source>To {}, axis {}, spin {} in the machine frame; {}</source>
        <translation>至 {}，刀轴 {}，自转角 {}（机床坐标系）；{}</translation>
    </message>
    <message>
        <source>Approach first</source>
        <translation>先接近</translation>
    </message>
    <message>
        <source>Repeat M codes</source>
        <translation>重复 M 代码</translation>
    </message>
    <message>
        <source>Single block</source>
        <translation>单段</translation>
    </message>
    <message>
        <source>Stop at M1</source>
        <translation>在 M1 处停止</translation>
    </message>
    <message>
        <source>Dry run at</source>
        <translation>空运行速度</translation>
    </message>
    <message>
        <source>Approach the start first; a start at a line always does</source>
        <translation>将刀具移到起点；从某一行开始时总是如此</translation>
    </message>
    <message>
        <source>Repeat the M codes of the machine before the line, each once, above it</source>
        <translation>在该行上方重复该行之前机床的 M 代码，每个一次</translation>
    </message>
    <message>
        <source>Stop at the end of each line, until Continue</source>
        <translation>在每一行末尾停下，直到按“继续”</translation>
    </message>
    <message>
        <source>Feed for all moves except rapids, without spindle, coolant and dwells</source>
        <translation>除快速移动外所有移动都用此进给速度，不启动主轴和冷却，不暂停</translation>
    </message>
    <message>
        <source>Open</source>
        <translation>打开</translation>
    </message>
    <message>
        <source>Open a posted trajectory</source>
        <translation>打开后处理得到的轨迹</translation>
    </message>
    <message>
        <source>Play it from the line onwards</source>
        <translation>从该行开始播放</translation>
    </message>
    <message>
        <source>Continue</source>
        <translation>继续</translation>
    </message>
    <message>
        <source>Continue after a stop, a block, a tool or an override of 0</source>
        <translation>在停止、单段、换刀或倍率为 0 之后继续</translation>
    </message>
    <message>
        <source>End</source>
        <translation>结束</translation>
    </message>
    <message>
        <source>End it at the next stop on the path</source>
        <translation>在路径上的下一个停止点结束</translation>
    </message>
    <message>
        <source>Retract by</source>
        <translation>退刀</translation>
    </message>
    <message>
        <source>Retract along the tool axis while it waits, as at feed 0; Continue returns first</source>
        <translation>等待时（例如进给为 0 时）沿刀轴向上退刀；“继续”先沿原路返回</translation>
    </message>
    <message>
        <source>the beginning</source>
        <translation>开头</translation>
    </message>
    <message>
        <source>Feed along the path; rapid moves are not faster than at 100 %</source>
        <translation>沿路径的进给；快速移动不会快于 100 % 时的速度</translation>
    </message>
    <message>
        <source>Begin at line</source>
        <translation>起始行</translation>
    </message>
    <message>
        <source>Feed</source>
        <translation>进给</translation>
    </message>
    <message>
        <source>no trajectory was opened</source>
        <translation>没有打开轨迹</translation>
    </message>
    <message>
        <source>Open a trajectory</source>
        <translation>打开轨迹</translation>
    </message>
    <message>
        <source>Not sent: the distance must be above zero</source>
        <translation>未发送：距离必须大于零</translation>
    </message>
    <message>
        <source>of any operation</source>
        <translation>任意工序</translation>
    </message>
    <message>
        <source>Open a motion program</source>
        <translation>打开运动程序</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>取消</translation>
    </message>
    <message>
        <source>Stop loading</source>
        <translation>停止下载</translation>
    </message>
    <message>
        <source>Load</source>
        <translation>下载</translation>
    </message>
    <message>
        <source>Load it, list it back and compare</source>
        <translation>下载到控制器，回读并比较</translation>
    </message>
    <message>
        <source>Approach</source>
        <translation>接近起点</translation>
    </message>
    <message>
        <source>Bring the tool to the start of the program, planned and checked</source>
        <translation>将刀具移到程序起点，路径经过规划和检查</translation>
    </message>
    <message>
        <source>Start</source>
        <translation>启动</translation>
    </message>
    <message>
        <source>Start it from its beginning</source>
        <translation>从头启动程序</translation>
    </message>
    <message>
        <source>Begin at block</source>
        <translation>起始程序段</translation>
    </message>
    <message>
        <source>Use it for single block</source>
        <translation>以此用于单段执行</translation>
    </message>
    <message>
        <source>Next block</source>
        <translation>下一程序段</translation>
    </message>
    <message>
        <source>Run the next line of its source, to rest</source>
        <translation>运行源程序的下一行，直到静止</translation>
    </message>
    <message>
        <source>Not sent: the block is refused</source>
        <translation>未发送：该程序段被拒绝</translation>
    </message>
    <message>
        <source>Continue after stop</source>
        <translation>停止后继续</translation>
    </message>
    <message>
        <source>Continue after the stop (M0, M1) at which the machine waits</source>
        <translation>从机床当前停止处 (M0, M1) 之后继续运行</translation>
    </message>
    <message>
        <source>no program was opened</source>
        <translation>未打开程序</translation>
    </message>
    <message>
        <source>Motion programs</source>
        <translation>运动程序</translation>
    </message>
    <message>
        <source>Not sent: no approach to the start was found</source>
        <translation>未发送：没有通往起点的路径</translation>
    </message>
    <message>
        <source>The program has {} blocks; block {} comes next</source>
        <translation>程序共有 {} 个程序段；下一个是程序段 {}</translation>
    </message>
    <message>
        <source>Length</source>
        <translation>杆长</translation>
    </message>
    <message>
        <source>Following error</source>
        <translation>跟随误差</translation>
    </message>
    <message>
        <source>State</source>
        <translation>状态</translation>
    </message>
    <message>
        <source>Frame of the large digits, and of lines of G-code</source>
        <translation>大号数字和 G 代码行所用的坐标系</translation>
    </message>
    <message>
        <source>Axis</source>
        <translation>刀轴</translation>
    </message>
    <message>
        <source>Tilt</source>
        <translation>倾角</translation>
    </message>
    <message>
        <source>In the machine frame: {}</source>
        <translation>机床坐标系中：{}</translation>
    </message>
    <message>
        <source>yes</source>
        <translation>是</translation>
    </message>
    <message>
        <source>no</source>
        <translation>否</translation>
    </message>
    <message>
        <source>Hold</source>
        <translation>进给保持</translation>
    </message>
    <message>
        <source>Slow down to rest, on the path</source>
        <translation>沿路径减速至静止</translation>
    </message>
    <message>
        <source>Resume</source>
        <translation>恢复</translation>
    </message>
    <message>
        <source>Continue after a hold</source>
        <translation>进给保持后继续</translation>
    </message>
    <message>
        <source>Abort</source>
        <translation>中止</translation>
    </message>
    <message>
        <source>Hold, then end the program</source>
        <translation>先进给保持，然后结束程序</translation>
    </message>
    <message>
        <source>Abort at once</source>
        <translation>立即中止</translation>
    </message>
    <message>
        <source>Each strut stops as fast as it can: the tool leaves its path</source>
        <translation>各支链以最快方式停止：刀具会偏离路径</translation>
    </message>
    <message>
        <source>Feed override of programs</source>
        <translation>倍率：程序中时间推进的快慢</translation>
    </message>
    <message>
        <source>Override</source>
        <translation>倍率</translation>
    </message>
    <message>
        <source>Nothing was read yet</source>
        <translation>尚未读取任何内容</translation>
    </message>
    <message>
        <source>no program runs</source>
        <translation>没有程序在运行</translation>
    </message>
    <message>
        <source>override {:g} %</source>
        <translation>倍率 {:g} %</translation>
    </message>
    <message>
        <source>block {} of {} comes next, line {}: {}</source>
        <translation>下一个是程序段 {}，共 {} 段，第 {} 行：{}</translation>
    </message>
    <message>
        <source>no home yet: strut {}</source>
        <translation>尚未回零：支链 {}</translation>
    </message>
    <message>
        <source>{} and {} to go; {}</source>
        <translation>剩余 {}，{}；{}</translation>
    </message>
    <message>
        <source>runs</source>
        <translation>运行中</translation>
    </message>
    <message>
        <source>held</source>
        <translation>已保持</translation>
    </message>
    <message>
        <source>rests</source>
        <translation>静止</translation>
    </message>
    <message>
        <source>no link: the machine comes to rest on the path</source>
        <translation>没有连接：机床在路径上停下</translation>
    </message>
    <message>
        <source>single block</source>
        <translation>单段</translation>
    </message>
    <message>
        <source>override 0</source>
        <translation>倍率 0</translation>
    </message>
    <message>
        <source>hold</source>
        <translation>进给保持</translation>
    </message>
    <message>
        <source>waits: {}</source>
        <translation>等待：{}</translation>
    </message>
    <message>
        <source>line {}</source>
        <translation>第 {} 行</translation>
    </message>
    <message>
        <source>feed {} ({:.0f} %)</source>
        <translation>进给 {}（{:.0f} %）</translation>
    </message>
    <message>
        <source>{} left</source>
        <translation>剩余 {}</translation>
    </message>
    <message>
        <source>feed {}, {:.0f} % reached</source>
        <translation>进给 {}，达到 {:.0f} %</translation>
    </message>
    <message>
        <source>Ended by the operator</source>
        <translation>由操作者结束</translation>
    </message>
    <message>
        <source>Played to the end</source>
        <translation>播放完毕</translation>
    </message>
    <message>
        <source>{} of motion</source>
        <translation>运动 {}</translation>
    </message>
    <message>
        <source>It came to rest {} times because the next piece came too late</source>
        <translation>因后续数据未及时到达而停下 {} 次</translation>
    </message>
    <message>
        <source>at least</source>
        <translation>至少</translation>
    </message>
    <message>
        <source>at most</source>
        <translation>至多</translation>
    </message>
    <message>
        <source>No file</source>
        <translation>没有文件</translation>
    </message>
    <message>
        <source>none</source>
        <translation>无</translation>
    </message>
    <message>
        <source>Part</source>
        <translation>零件</translation>
    </message>
    <message>
        <source>The finished part</source>
        <translation>加工完成的零件</translation>
    </message>
    <message>
        <source>Stock</source>
        <translation>毛坯</translation>
    </message>
    <message>
        <source>The stock before the first operation</source>
        <translation>第一个操作之前的毛坯</translation>
    </message>
    <message>
        <source>Fixtures</source>
        <translation>夹具</translation>
    </message>
    <message>
        <source>Clamps and vices, one or several files</source>
        <translation>压板和虎钳，一个或多个文件</translation>
    </message>
    <message>
        <source>Skip /</source>
        <translation>跳过 /</translation>
    </message>
    <message>
        <source>The posting with the blocks after / skipped</source>
        <translation>不含 / 后程序段的后处理结果</translation>
    </message>
    <message>
        <source>The same program posted with --block-delete</source>
        <translation>同一程序用 --block-delete 后处理得到的轨迹</translation>
    </message>
    <message>
        <source>no posting with the blocks after / skipped was opened</source>
        <translation>没有打开不含 / 后程序段的后处理结果</translation>
    </message>
    <message>
        <source>Skip the next blocks after /</source>
        <translation>跳过接下来 / 后的程序段</translation>
    </message>
    <message>
        <source>At the machine</source>
        <translation>机床上的改动</translation>
    </message>
    <message>
        <source>Solids</source>
        <translation>实体</translation>
    </message>
    <message>
        <source>Shift of the work offset since the posting: X, Y, Z</source>
        <translation>后处理之后工件偏置的移动：X、Y、Z</translation>
    </message>
    <message>
        <source>Check the approach against</source>
        <translation>检查到起点的路线是否碰到</translation>
    </message>
    <message>
        <source>Displacement of the work offset in the machine frame, as printed by measure</source>
        <translation>工件偏置在机床坐标系中移动了多少，即 measure 所显示的值</translation>
    </message>
    <message>
        <source>Current gauge length of the tool, if changed since the posting</source>
        <translation>刀具现在的长度（主轴端面到刀尖），代替后处理时的长度</translation>
    </message>
    <message>
        <source>STL or STEP file, mm in the work frame</source>
        <translation>STL 或 STEP 文件，工件坐标系，单位 mm</translation>
    </message>
    <message>
        <source>Trajectories</source>
        <translation>轨迹</translation>
    </message>
</context>
<context>
    <name>Core</name>
    <message>
        <source>the program has an unknown or misplaced line</source>
        <translation>程序有一行未知或位置不对</translation>
    </message>
    <message>
        <source>post the job again; do not edit the program</source>
        <translation>重新对作业进行后处理；不要编辑程序</translation>
    </message>
    <message>
        <source>the program is larger than the controller&apos;s memory and has no rest where it can be split</source>
        <translation>程序超过控制器的内存，且没有可以分割的静止处</translation>
    </message>
    <message>
        <source>post fewer operations at a time, or put a stop into the job where the tool is free; or post it with a higher controller.memory_words, and play the trajectory (pmac play)</source>
        <translation>每次对较少的操作进行后处理，或在作业中刀具离开工件处加入停止；或以更大的 controller.memory_words 进行后处理，并播放轨迹 (pmac play)</translation>
    </message>
    <message>
        <source>the line is too long for the controller</source>
        <translation>该行对控制器来说太长</translation>
    </message>
    <message>
        <source>use fewer decimals in the machine file</source>
        <translation>在机床文件中使用更少的小数位</translation>
    </message>
    <message>
        <source>an event has no code of the controller</source>
        <translation>一个事件没有对应的控制器代码</translation>
    </message>
    <message>
        <source>give it one under [controller.codes] in the machine file</source>
        <translation>在机床文件的 [controller.codes] 中给出</translation>
    </message>
    <message>
        <source>the parts of the program do not belong together</source>
        <translation>程序的各部分不属于同一组</translation>
    </message>
    <message>
        <source>keep all parts of one posting together; post the job again</source>
        <translation>将一次后处理的所有部分放在一起；重新对作业进行后处理</translation>
    </message>
    <message>
        <source>the table has a malformed line</source>
        <translation>表中有一行的格式错误</translation>
    </message>
    <message>
        <source>post the job again; do not edit the table</source>
        <translation>重新对作业进行后处理；不要编辑该表</translation>
    </message>
    <message>
        <source>the table differs from the motion it was made from</source>
        <translation>表与生成它的运动不一致</translation>
    </message>
    <message>
        <source>the program has a character that the controller does not accept, or executes immediately</source>
        <translation>程序中有控制器不接受或会立即执行的字符</translation>
    </message>
    <message>
        <source>the program was changed: the SHA-256 in its heading is not that of its lines</source>
        <translation>程序已被更改：其开头的 SHA-256 与各行内容不符</translation>
    </message>
    <message>
        <source>nothing shows that the program was certified</source>
        <translation>没有任何内容表明程序经过验证</translation>
    </message>
    <message>
        <source>keep the trajectory file, the report and all parts of one posting in the folder of the program, or post the job again; pmac --uncertified loads it nevertheless</source>
        <translation>将一次后处理的轨迹文件、报告和所有部分放在程序所在的文件夹中，或重新对作业进行后处理；pmac --uncertified 仍可下载它</translation>
    </message>
    <message>
        <source>the program has tools of several lengths, and the form in tip and axis knows one</source>
        <translation>程序有多种长度的刀具，而刀尖和刀轴形式只有一种长度</translation>
    </message>
    <message>
        <source>post the operations of each tool as a program of their own, or load the program of strut lengths</source>
        <translation>将每把刀具的操作分别后处理为单独的程序，或下载杆长程序</translation>
    </message>
    <message>
        <source>the program does not hold within the permitted changes at the machine</source>
        <translation>考虑在机床上可能的更改时，程序不成立</translation>
    </message>
    <message>
        <source>permit less, by --tool-range and --origin-range, or move the part; the faults that follow are those at a corner of this range</source>
        <translation>用 --tool-range 和 --origin-range 减小允许的范围，或移动零件；以下是在那种情况下的错误</translation>
    </message>
    <message>
        <source>the program does not hold with this segment time</source>
        <translation>采用此分段时间时，程序不成立</translation>
    </message>
    <message>
        <source>the command moves nothing</source>
        <translation>该命令不产生任何运动</translation>
    </message>
    <message>
        <source>no pose of the platform belongs to the strut lengths on the way</source>
        <translation>途中的杆长没有对应的动平台位姿</translation>
    </message>
    <message>
        <source>jog less far, or jog the tool</source>
        <translation>减小点动距离，或点动刀具</translation>
    </message>
    <message>
        <source>a line that is entered by hand cannot change the tool</source>
        <translation>手动输入的行不能换刀</translation>
    </message>
    <message>
        <source>change it by hand, and enter its gauge length</source>
        <translation>手动换刀，并输入其刀具长度</translation>
    </message>
    <message>
        <source>the motion needs more memory than one program has</source>
        <translation>运动所需的内存超过一个程序的内存</translation>
    </message>
    <message>
        <source>jog less far, or program a higher feed</source>
        <translation>减小点动距离，或提高编程进给</translation>
    </message>
    <message>
        <source>the source lines of the program are unknown</source>
        <translation>程序的源行未知</translation>
    </message>
    <message>
        <source>keep all results of a posting together in one folder, or post the job again</source>
        <translation>将一次后处理的所有结果放在同一文件夹中，或重新对作业进行后处理</translation>
    </message>
    <message>
        <source>the trajectory has no line to begin with</source>
        <translation>轨迹没有可以开始的行</translation>
    </message>
    <message>
        <source>name a line up to the last one that moves, and the operation it belongs to with --operation</source>
        <translation>指定不超过最后一个移动的行，并用 --operation 指定其所属的操作</translation>
    </message>
    <message>
        <source>another client controls the machine</source>
        <translation>另一个客户端正在控制机床</translation>
    </message>
    <message>
        <source>wait until it ends, or end it; if it no longer exists, stop the machine first (hold, then abort); status, monitor, hold and abort remain available</source>
        <translation>等待其结束，或将其结束；如果它已不存在，先使机床停下（先进给保持，再中止）；查看状态、监视、进给保持和中止仍可使用</translation>
    </message>
    <message>
        <source>another client has taken control of the machine</source>
        <translation>另一个客户端接管了机床的控制</translation>
    </message>
    <message>
        <source>check what the machine does, and start again when the other client has ended</source>
        <translation>检查机床在做什么，待另一个客户端结束后重新开始</translation>
    </message>
    <message>
        <source>the lock of the controller cannot be kept on this computer</source>
        <translation>不能在此计算机上保持控制器的锁</translation>
    </message>
    <message>
        <source>make the folder for temporary files writable</source>
        <translation>使临时文件的文件夹可写</translation>
    </message>
    <message>
        <source>the variables that identify the controlling client have invalid values</source>
        <translation>标识控制客户端的变量的值无效</translation>
    </message>
    <message>
        <source>keep P8187 to P8191 free in the programs of the controller; P8187..8191=0 in the terminal frees them</source>
        <translation>控制器的程序中不要使用 P8187 到 P8191；在终端中用 P8187..8191=0 释放它们</translation>
    </message>
    <message>
        <source>a program buffer is open that this port cannot close</source>
        <translation>一个程序缓冲区处于打开状态，此端口不能将其关闭</translation>
    </message>
    <message>
        <source>close it where it was opened, or disconnect what loads a program there</source>
        <translation>在打开它的地方将其关闭，或断开正在那里下载程序的设备</translation>
    </message>
    <message>
        <source>the file with the known host keys cannot be read</source>
        <translation>记录已知主机密钥的文件不能读取</translation>
    </message>
    <message>
        <source>correct or remove that line, or name another file with --known-hosts</source>
        <translation>改正或删除该行，或用 --known-hosts 指定其他文件</translation>
    </message>
    <message>
        <source>the touch probe is touched before its move</source>
        <translation>测头在移动之前已触发</translation>
    </message>
    <message>
        <source>jog it free; if it is free, state the value of its input with --input, as M1000=0</source>
        <translation>点动使其脱离；如果已经脱离，用 --input 给出其输入的值，例如 M1000=0</translation>
    </message>
    <message>
        <source>the touch probe met nothing</source>
        <translation>测头没有碰到任何物体</translation>
    </message>
    <message>
        <source>begin closer, or allow a longer way with --within</source>
        <translation>从更近处开始，或用 --within 允许更长的路径</translation>
    </message>
    <message>
        <source>the touch probe stays touched where its move began</source>
        <translation>测头在其移动开始处仍处于触发状态</translation>
    </message>
    <message>
        <source>jog it free and look at the probe and its input</source>
        <translation>点动使其脱离，并检查测头及其输入</translation>
    </message>
    <message>
        <source>the touch probe was touched on a way that should be free</source>
        <translation>测头在应无障碍的路径上触发</translation>
    </message>
    <message>
        <source>jog it free, and give --diameter, --depth and --clearance as the part has them</source>
        <translation>点动使其脱离，并按零件给出 --diameter、--depth 和 --clearance</translation>
    </message>
    <message>
        <source>the output cannot be written</source>
        <translation>输出不能写出</translation>
    </message>
    <message>
        <source>check the folder, its permissions and the free space</source>
        <translation>检查文件夹、其权限和剩余空间</translation>
    </message>
    <message>
        <source>the picture was not made: matplotlib is missing or cannot be imported</source>
        <translation>没有生成图片：缺少 matplotlib 或不能导入</translation>
    </message>
    <message>
        <source>install it, as by python3 -m pkm_post install matplotlib, in a version that fits NumPy</source>
        <translation>安装与 NumPy 相配的版本，例如用 python3 -m pkm_post install matplotlib</translation>
    </message>
    <message>
        <source>the file cannot be read</source>
        <translation>文件不能读取</translation>
    </message>
    <message>
        <source>check the path and its permissions</source>
        <translation>检查路径及其权限</translation>
    </message>
    <message>
        <source>the folder has files of an earlier result that do not belong to this one</source>
        <translation>文件夹中有不属于本次结果的以前的文件</translation>
    </message>
    <message>
        <source>remove them, so that they are not run with this program</source>
        <translation>删除它们，以免与此程序一起运行</translation>
    </message>
    <message>
        <source>results of two jobs would have the same name</source>
        <translation>两个作业的结果会同名</translation>
    </message>
    <message>
        <source>results are not those that were posted together</source>
        <translation>这些结果不是同一次后处理得到的</translation>
    </message>
    <message>
        <source>post again, or bring back every file that the manifest lists</source>
        <translation>重新后处理，或恢复清单列出的每个文件</translation>
    </message>
    <message>
        <source>no manifest lists this file and its results</source>
        <translation>没有清单列出此文件及其结果</translation>
    </message>
    <message>
        <source>post again, and keep the manifest and all that it lists with the program</source>
        <translation>重新后处理，并将清单及其列出的所有文件与程序放在一起</translation>
    </message>
    <message>
        <source>the manifest of results cannot be read</source>
        <translation>结果清单不能读取</translation>
    </message>
    <message>
        <source>post again, or bring back the manifest</source>
        <translation>重新后处理，或恢复清单</translation>
    </message>
    <message>
        <source>another process is moving its files into the folder</source>
        <translation>另一个进程正在将其文件移入该文件夹</translation>
    </message>
    <message>
        <source>try again when it has ended, or choose another folder</source>
        <translation>等其结束后再试，或选择其他文件夹</translation>
    </message>
    <message>
        <source>not all files were replaced, and earlier files could not be restored</source>
        <translation>并非所有文件都已替换，以前的文件也未能恢复</translation>
    </message>
    <message>
        <source>close the programs that have the named files open, remove them, and try again</source>
        <translation>关闭打开了所列文件的程序，删除这些文件，然后再试</translation>
    </message>
    <message>
        <source>CAM&apos;s dialog saves one text, and this result has several files</source>
        <translation>CAM 的对话框只保存一个文本，而此结果有多个文件</translation>
    </message>
    <message>
        <source>post with Post of the PKM Post workbench, which writes them together</source>
        <translation>用 PKM Post 工作台的“后处理”，它将所有文件一起写出</translation>
    </message>
    <message>
        <source>CAM&apos;s dialog saves the program alone</source>
        <translation>CAM 的对话框只保存程序</translation>
    </message>
    <message>
        <source>post with Post of the PKM Post workbench to have its report, trajectory and set-up file beside it: a program without them is not loaded into the controller (C110)</source>
        <translation>用 PKM Post 工作台的“后处理”，使报告、轨迹和设置文件与程序放在一起：没有这些文件的程序不会下载到控制器 (C110)</translation>
    </message>
    <message>
        <source>a file is open in another program</source>
        <translation>一个文件正被另一个程序打开</translation>
    </message>
    <message>
        <source>close it there, or wait until a virus scanner or a cloud folder has done with it, and try again</source>
        <translation>在那里关闭它，或等待病毒扫描程序或云文件夹用完，然后再试</translation>
    </message>
    <message>
        <source>a result cannot have this name</source>
        <translation>结果不能使用此名称</translation>
    </message>
    <message>
        <source>choose another name for the program or the job, or a folder with a shorter path</source>
        <translation>为程序或作业选择其他名称，或选择路径更短的文件夹</translation>
    </message>
    <message>
        <source>the number of threads is not a whole number above zero</source>
        <translation>线程数不是大于零的整数</translation>
    </message>
    <message>
        <source>set PKM_THREADS to one, or do not set it</source>
        <translation>将 PKM_THREADS 设为这样的数，或不设置</translation>
    </message>
    <message>
        <source>the list of jobs is not valid</source>
        <translation>作业列表无效</translation>
    </message>
    <message>
        <source>write it as docs/command-line.md describes it</source>
        <translation>按 docs/command-line.md 所述书写</translation>
    </message>
    <message>
        <source>there is something of this name already</source>
        <translation>已有同名的内容</translation>
    </message>
    <message>
        <source>choose another folder for the result, or remove what is there</source>
        <translation>为结果选择其他文件夹，或删除已有的内容</translation>
    </message>
    <message>
        <source>a result would replace a file that it is made from</source>
        <translation>结果会覆盖生成它所用的文件</translation>
    </message>
    <message>
        <source>there is not enough memory</source>
        <translation>内存不足</translation>
    </message>
    <message>
        <source>close other programs, do fewer operations or files at a time, or use a computer with more memory</source>
        <translation>关闭其他程序，每次处理较少的操作或文件，或使用内存更大的计算机</translation>
    </message>
    <message>
        <source>FreeCAD could not be started</source>
        <translation>FreeCAD 不能启动</translation>
    </message>
    <message>
        <source>install FreeCAD 1.0 or newer, or name its FreeCADCmd in the environment variable FREECADCMD</source>
        <translation>安装 FreeCAD 1.0 或更新的版本，或在环境变量 FREECADCMD 中指定其 FreeCADCmd</translation>
    </message>
    <message>
        <source>FreeCAD ended before the command had run in it</source>
        <translation>命令在 FreeCAD 中运行之前 FreeCAD 就结束了</translation>
    </message>
    <message>
        <source>read the output above; FREECADCMD, if set, must name FreeCADCmd of FreeCAD 1.0 or newer</source>
        <translation>查看此前的输出；如果设置了 FREECADCMD，确认它指定的是 FreeCAD 1.0 或更新版本的 FreeCADCmd</translation>
    </message>
    <message>
        <source>a result is missing</source>
        <translation>缺少一个结果</translation>
    </message>
    <message>
        <source>run the script in FreeCADCmd, or post with python3 -m pkm_post post, which starts it</source>
        <translation>请在 FreeCADCmd 中运行该脚本，或用会启动它的 python3 -m pkm_post post 进行后处理</translation>
    </message>
    <message>
        <source>a character is not allowed here</source>
        <translation>此处不允许该字符</translation>
    </message>
    <message>
        <source>remove it, or put the text into a comment</source>
        <translation>删除它，或将文字放入注释</translation>
    </message>
    <message>
        <source>a number is malformed</source>
        <translation>数的格式错误</translation>
    </message>
    <message>
        <source>write it as -12.5: one sign, one point, no blanks and no exponent</source>
        <translation>写成 -12.5 的形式：一个符号，一个小数点，没有空格，没有指数</translation>
    </message>
    <message>
        <source>a number is too large</source>
        <translation>数太大</translation>
    </message>
    <message>
        <source>correct the number</source>
        <translation>改正该数</translation>
    </message>
    <message>
        <source>a line is too long</source>
        <translation>行太长</translation>
    </message>
    <message>
        <source>split it; a block has at most 10000 characters</source>
        <translation>将其拆开；一个程序段最多 10000 个字符</translation>
    </message>
    <message>
        <source>the G or M code does not exist</source>
        <translation>没有这个 G 或 M 代码</translation>
    </message>
    <message>
        <source>write G with at most one decimal, M with none, no sign</source>
        <translation>G 最多带一位小数，M 不带小数，均不带符号</translation>
    </message>
    <message>
        <source>there are more faults than are shown</source>
        <translation>错误数量超过所显示的数量</translation>
    </message>
    <message>
        <source>correct those that are shown, then check again</source>
        <translation>改正已显示的错误，然后再次检查</translation>
    </message>
    <message>
        <source>a word has no number</source>
        <translation>地址字没有数值</translation>
    </message>
    <message>
        <source>write a number, a parameter or an expression after the letter</source>
        <translation>在字母后写出数、参数或表达式</translation>
    </message>
    <message>
        <source>a block has two values of one letter</source>
        <translation>一个程序段中同一字母有两个值</translation>
    </message>
    <message>
        <source>remove one of them, or make it two blocks</source>
        <translation>删除其中一个，或分成两个程序段</translation>
    </message>
    <message>
        <source>a comment contains another comment</source>
        <translation>注释中含有另一个注释</translation>
    </message>
    <message>
        <source>remove the inner parentheses</source>
        <translation>去掉里面的括号</translation>
    </message>
    <message>
        <source>a comment is not closed</source>
        <translation>注释没有结束</translation>
    </message>
    <message>
        <source>close it with ) on the same line</source>
        <translation>在同一行内用 ) 结束</translation>
    </message>
    <message>
        <source>a bracket is not closed</source>
        <translation>方括号没有结束</translation>
    </message>
    <message>
        <source>close it with ] on the same line</source>
        <translation>在同一行内用 ] 结束</translation>
    </message>
    <message>
        <source>unexpected text in the block</source>
        <translation>程序段中有意外的文字</translation>
    </message>
    <message>
        <source>write what is expected there, or put it on a line of its own</source>
        <translation>写出此处应有的内容，或将其另写一行</translation>
    </message>
    <message>
        <source>an end has no matching beginning</source>
        <translation>结束语句没有对应的开始</translation>
    </message>
    <message>
        <source>remove it, or add the beginning</source>
        <translation>删除它，或补上开始语句</translation>
    </message>
    <message>
        <source>a name is malformed</source>
        <translation>名称的格式错误</translation>
    </message>
    <message>
        <source>write names as &lt;name&gt;, of letters, digits, blanks, _, ., : and -</source>
        <translation>名称写成 &lt;name&gt; 的形式，由字母、数字、空格、_、.、: 和 - 组成</translation>
    </message>
    <message>
        <source>a value is missing</source>
        <translation>缺少一个值</translation>
    </message>
    <message>
        <source>write a number, a parameter or an expression in its place</source>
        <translation>在此处写出数、参数或表达式</translation>
    </message>
    <message>
        <source>a part of the block is in the wrong place</source>
        <translation>程序段的一部分位置不对</translation>
    </message>
    <message>
        <source>write / first, then N; O words, LN and % begin a block; NX to TZ stand after LN</source>
        <translation>先写 /，再写 N；O 字、LN 和 % 位于程序段开头；NX 到 TZ 位于 LN 之后</translation>
    </message>
    <message>
        <source>an expression is nested too deeply</source>
        <translation>表达式嵌套过深</translation>
    </message>
    <message>
        <source>split it, with parameters for its parts</source>
        <translation>将其拆开，用参数存放各部分</translation>
    </message>
    <message>
        <source>blocks after the percent sign that ends the file are not read</source>
        <translation>结束文件的百分号之后的程序段不被读取</translation>
    </message>
    <message>
        <source>remove them, or the sign</source>
        <translation>删除这些程序段，或删除百分号</translation>
    </message>
    <message>
        <source>the program is in another language than G-code</source>
        <translation>程序使用的语言不是 G 代码</translation>
    </message>
    <message>
        <source>read Siemens&apos;s language with --flavour siemens; else post it again for a control that reads G-code</source>
        <translation>西门子语言的程序用 --flavour siemens 读取；否则重新后处理为使用 G 代码的数控系统的程序</translation>
    </message>
    <message>
        <source>a length has no decimal point, and is taken in whole units</source>
        <translation>一个长度没有小数点，按整数单位处理</translation>
    </message>
    <message>
        <source>write a point; some controls take such a number for thousandths, others for whole mm or inches as here</source>
        <translation>写出小数点；有些数控系统将这样的数视为千分之一，另一些与此处相同，视为整毫米或整英寸</translation>
    </message>
    <message>
        <source>a parameter has no value</source>
        <translation>参数没有值</translation>
    </message>
    <message>
        <source>assign a value first</source>
        <translation>先赋值</translation>
    </message>
    <message>
        <source>the parameter does not exist</source>
        <translation>没有这个参数</translation>
    </message>
    <message>
        <source>use whole numbers from 1 to 5601, or a name</source>
        <translation>使用 1 到 5601 的整数，或名称</translation>
    </message>
    <message>
        <source>the parameter belongs to the control, and its value is unknown</source>
        <translation>该参数属于数控系统，其值未知</translation>
    </message>
    <message>
        <source>write the value itself</source>
        <translation>直接写出数值</translation>
    </message>
    <message>
        <source>a division by zero</source>
        <translation>除数为零</translation>
    </message>
    <message>
        <source>correct the divisor</source>
        <translation>改正除数</translation>
    </message>
    <message>
        <source>the value cannot be computed</source>
        <translation>该值不能计算</translation>
    </message>
    <message>
        <source>use values for which the function or operator is defined</source>
        <translation>使用函数或运算符有定义的值</translation>
    </message>
    <message>
        <source>the value is not a G or M code</source>
        <translation>该值不是 G 或 M 代码</translation>
    </message>
    <message>
        <source>use a number with at most one decimal for G, a whole number for M</source>
        <translation>G 使用最多一位小数的数，M 使用整数</translation>
    </message>
    <message>
        <source>an O word has no matching beginning</source>
        <translation>O 字没有对应的开始</translation>
    </message>
    <message>
        <source>write the beginning first, with the same label</source>
        <translation>先写出标号相同的开始语句</translation>
    </message>
    <message>
        <source>a subprogram, loop or branch has no end</source>
        <translation>子程序、循环或分支没有结束</translation>
    </message>
    <message>
        <source>end it: sub, if, while, do and repeat by O word, O numbers by M99</source>
        <translation>写出其结束：sub、if、while、do 和 repeat 用 O 字，带编号的 O 用 M99</translation>
    </message>
    <message>
        <source>there is no such subprogram</source>
        <translation>没有这个子程序</translation>
    </message>
    <message>
        <source>put it into the program, or into a file of its number or name, such as O1234.nc or name.ngc, beside it or in a folder that --subprograms names</source>
        <translation>将其写入程序，或写入以其编号或名称命名的文件（例如 O1234.nc 或 name.ngc），放在程序旁边或 --subprograms 指定的文件夹中</translation>
    </message>
    <message>
        <source>a label is used twice</source>
        <translation>一个标号使用了两次</translation>
    </message>
    <message>
        <source>give each its own label</source>
        <translation>为每处使用各自的标号</translation>
    </message>
    <message>
        <source>this is not a label</source>
        <translation>这不是标号</translation>
    </message>
    <message>
        <source>this is not allowed here</source>
        <translation>此处不允许这样写</translation>
    </message>
    <message>
        <source>call with call and end with endsub, or with M98 and M99</source>
        <translation>用 call 调用并以 endsub 结束，或用 M98 和 M99</translation>
    </message>
    <message>
        <source>the program does not end</source>
        <translation>程序不会结束</translation>
    </message>
    <message>
        <source>change in each loop what its condition depends on; end with M30, not with a jump back; divide longer programs</source>
        <translation>在每个循环中改变其条件所依赖的量；以 M30 结束，而不是向后跳转；将更长的程序拆分</translation>
    </message>
    <message>
        <source>subprograms call each other too deeply</source>
        <translation>子程序相互调用的层次过深</translation>
    </message>
    <message>
        <source>let none call itself, and nest calls less deeply</source>
        <translation>不要让子程序调用自身，并减少调用的嵌套层数</translation>
    </message>
    <message>
        <source>a call has too many arguments</source>
        <translation>调用的自变量太多</translation>
    </message>
    <message>
        <source>pass at most 30</source>
        <translation>最多传递 30 个</translation>
    </message>
    <message>
        <source>this is not a call of a subprogram</source>
        <translation>这不是子程序调用</translation>
    </message>
    <message>
        <source>write M98 P and L with whole numbers, P always, and no M99; G67 before what may not stand under G66</source>
        <translation>M98 的 P 和 L 写整数，P 必须写出，且不写 M99；不得处于 G66 之下的内容之前先写 G67</translation>
    </message>
    <message>
        <source>the tool axis or normal cannot be given in this way here</source>
        <translation>此处不能这样给出刀轴或法线</translation>
    </message>
    <message>
        <source>write the tool axis alone, on straight moves</source>
        <translation>在直线移动上单独写出刀轴</translation>
    </message>
    <message>
        <source>several files may be the subprogram</source>
        <translation>有多个文件可能是该子程序</translation>
    </message>
    <message>
        <source>leave one of them in the folder, or give the folder with the right one with --subprograms</source>
        <translation>文件夹中只保留其中一个，或用 --subprograms 给出正确文件所在的文件夹</translation>
    </message>
    <message>
        <source>the program stops with an alarm of its own</source>
        <translation>程序因自身的报警而停止</translation>
    </message>
    <message>
        <source>correct what the message beside it says, such as a missing argument</source>
        <translation>按其旁边的信息改正，例如补上缺少的自变量</translation>
    </message>
    <message>
        <source>there is no block with this sequence number</source>
        <translation>没有此顺序号的程序段</translation>
    </message>
    <message>
        <source>write the block&apos;s N, or correct the jump</source>
        <translation>为该程序段写出 N，或改正跳转</translation>
    </message>
    <message>
        <source>the code is not supported</source>
        <translation>不支持该代码</translation>
    </message>
    <message>
        <source>replace it by supported codes, or, if it does not move the tool, leave it out with --leave-out or with part_programs.leave_out of the machine file; M codes that the controller is to get belong in controller.codes.functions there</source>
        <translation>用支持的代码代替；如果它不移动刀具，可用 --leave-out 或机床文件的 part_programs.leave_out 略去；应传给控制器的 M 代码写入机床文件的 controller.codes.functions</translation>
    </message>
    <message>
        <source>the code has no meaning on this machine</source>
        <translation>该代码在此机床上没有意义</translation>
    </message>
    <message>
        <source>two codes of one group in a block exclude each other</source>
        <translation>同一程序段中同组的两个代码相互排斥</translation>
    </message>
    <message>
        <source>write them in two blocks</source>
        <translation>写成两个程序段</translation>
    </message>
    <message>
        <source>no code of the block uses the word</source>
        <translation>程序段中没有代码使用这个字</translation>
    </message>
    <message>
        <source>remove it, or add the code that it belongs to</source>
        <translation>删除它，或补上它所属的代码</translation>
    </message>
    <message>
        <source>a word is missing</source>
        <translation>缺少一个字</translation>
    </message>
    <message>
        <source>add it</source>
        <translation>补上它</translation>
    </message>
    <message>
        <source>a word has an invalid value</source>
        <translation>字的值无效</translation>
    </message>
    <message>
        <source>the axis words are ambiguous</source>
        <translation>轴的字有歧义</translation>
    </message>
    <message>
        <source>a cutting move has no feed</source>
        <translation>切削移动没有进给速度</translation>
    </message>
    <message>
        <source>write F above zero before the move, or in it with G93, or give --feed</source>
        <translation>在移动之前写出大于零的 F，使用 G93 时写在移动中，或给出 --feed</translation>
    </message>
    <message>
        <source>the arc does not fit its end points</source>
        <translation>圆弧与其端点不相符</translation>
    </message>
    <message>
        <source>correct end point, centre or radius</source>
        <translation>改正终点、圆心或半径</translation>
    </message>
    <message>
        <source>the arc has no centre</source>
        <translation>圆弧没有圆心</translation>
    </message>
    <message>
        <source>write I J K of its plane, or R, which is CR= in Siemens&apos;s language</source>
        <translation>写出其平面的 I J K，或 R（西门子语言中为 CR=）</translation>
    </message>
    <message>
        <source>the tool is unknown</source>
        <translation>刀具未知</translation>
    </message>
    <message>
        <source>give its diameter and corner radius: --tool NUMBER=D[,R]</source>
        <translation>给出其直径和圆角半径：--tool NUMBER=D[,R]</translation>
    </message>
    <message>
        <source>the offset of this coordinate system is unknown</source>
        <translation>该坐标系的偏置未知</translation>
    </message>
    <message>
        <source>give it with --origin NAME=X,Y,Z, or set it with G10 L2; for G53 give the place of the machine&apos;s zero with --machine-zero X,Y,Z</source>
        <translation>用 --origin NAME=X,Y,Z 给出，或用 G10 L2 设置；对 G53 用 --machine-zero X,Y,Z 给出机床零点的位置</translation>
    </message>
    <message>
        <source>the reference point is unknown</source>
        <translation>参考点未知</translation>
    </message>
    <message>
        <source>give it with --machine-zero X,Y,Z, or set it with G28.1 or G30.1</source>
        <translation>用 --machine-zero X,Y,Z 给出，或用 G28.1 或 G30.1 设置</translation>
    </message>
    <message>
        <source>rotary words have no meaning here</source>
        <translation>旋转轴的字在此处没有意义</translation>
    </message>
    <message>
        <source>give the rotary axes with --axis-words, and write G43.4 before cuts with a tilted tool, G69 and G50.1 before words that tilt it</source>
        <translation>用 --axis-words 给出旋转轴，并在倾斜刀具切削之前写 G43.4，并在使其倾斜的字之前写 G69 和 G50.1</translation>
    </message>
    <message>
        <source>the tool axis is unknown</source>
        <translation>刀轴未知</translation>
    </message>
    <message>
        <source>write I, J and K, not all zero, after G43.5</source>
        <translation>在 G43.5 之后写出不全为零的 I、J 和 K</translation>
    </message>
    <message>
        <source>the position of the tool is not yet known</source>
        <translation>刀具的位置尚未知道</translation>
    </message>
    <message>
        <source>first move to X, Y and Z</source>
        <translation>先移动到 X、Y 和 Z</translation>
    </message>
    <message>
        <source>the path tolerance of the program is not used</source>
        <translation>程序的路径公差未被使用</translation>
    </message>
    <message>
        <source>write G64 with a P above zero, alone</source>
        <translation>单独写 G64，其 P 大于零</translation>
    </message>
    <message>
        <source>the cycle cannot be executed</source>
        <translation>循环不能执行</translation>
    </message>
    <message>
        <source>correct its words</source>
        <translation>改正其中的字</translation>
    </message>
    <message>
        <source>this is not allowed while cutter compensation is active</source>
        <translation>刀具半径补偿有效时不允许这样做</translation>
    </message>
    <message>
        <source>cancel it with G40 first</source>
        <translation>先用 G40 取消补偿</translation>
    </message>
    <message>
        <source>the program contains no motion</source>
        <translation>程序中没有运动</translation>
    </message>
    <message>
        <source>check the file</source>
        <translation>检查文件</translation>
    </message>
    <message>
        <source>the active length offset is not that of the tool, and the tool axis can tilt</source>
        <translation>当前的刀具长度补偿不是该刀具的，而刀轴可能倾斜</translation>
    </message>
    <message>
        <source>write the tool&apos;s own H</source>
        <translation>写出该刀具自己的 H</translation>
    </message>
    <message>
        <source>the surface normal is unknown</source>
        <translation>曲面法线未知</translation>
    </message>
    <message>
        <source>write NX, NY and NZ, not all zero</source>
        <translation>写出不全为零的 NX、NY 和 NZ</translation>
    </message>
    <message>
        <source>the surface normal was not of unit length and was normalised</source>
        <translation>曲面法线不是单位长度，已归一化</translation>
    </message>
    <message>
        <source>write unit vectors with 6 decimals</source>
        <translation>写出有 6 位小数的单位向量</translation>
    </message>
    <message>
        <source>the tool is tilted, and X Y Z do not refer to its tip</source>
        <translation>刀具已倾斜，而 X Y Z 不是刀尖的坐标</translation>
    </message>
    <message>
        <source>write upright words for the tool axis before TRAFOOF, G43 or G49, or TRAORI, G43.4 or G43.5 before the move</source>
        <translation>在 TRAFOOF、G43 或 G49 之前写出使刀轴竖直的字，或在移动之前写 TRAORI、G43.4 或 G43.5</translation>
    </message>
    <message>
        <source>mill the threads as helices; or tap them by G74 or G84 with S and F, on a machine whose spindle is an axis: state [spindle.axis] in its machine file</source>
        <translation>用螺旋线铣削螺纹;或者在主轴可作为轴的机床上,用带 S 和 F 的 G74 或 G84 攻丝:在其机床文件中写明 [spindle.axis]</translation>
    </message>
    <message>
        <source>the modal words of the cycle are ambiguous here</source>
        <translation>循环的模态字在此处有歧义</translation>
    </message>
    <message>
        <source>write R and the depth again where G90, G91 or the unit changes; write G80 before another plane or height of the origin, and the whole cycle after it</source>
        <translation>在 G90、G91 或单位改变处重新写出 R 和深度；在更换平面或改变原点高度之前写 G80，其后重新写出整个循环</translation>
    </message>
    <message>
        <source>a dwell in milliseconds has a decimal point</source>
        <translation>以毫秒为单位的暂停带有小数点</translation>
    </message>
    <message>
        <source>write whole milliseconds without a point, or seconds in the whole program and --dwell-unit s</source>
        <translation>写出不带小数点的整毫秒，或整个程序使用秒并给出 --dwell-unit s</translation>
    </message>
    <message>
        <source>a dwell lasts longer than a minute</source>
        <translation>暂停超过一分钟</translation>
    </message>
    <message>
        <source>check it; read a part program whose dwells are in ms with --dwell-unit ms</source>
        <translation>请检查；暂停以毫秒为单位的零件程序用 --dwell-unit ms 读取</translation>
    </message>
    <message>
        <source>a cycle drills along the normal of its plane, and the tool is tilted against it</source>
        <translation>循环沿其平面的法向钻孔，而刀具相对该方向倾斜</translation>
    </message>
    <message>
        <source>write the hole as G0 and G1 along the tool, or set the tool upright before the cycle</source>
        <translation>用沿刀轴的 G0 和 G1 写出该孔，或在循环之前使刀具竖直</translation>
    </message>
    <message>
        <source>the program has no end: it may be truncated</source>
        <translation>程序没有结束：可能不完整</translation>
    </message>
    <message>
        <source>get the complete file; if it is complete, add M2 or M30 at its end, give --allow-open-end, or set OpenEnd of the program object</source>
        <translation>取得完整的文件；如果已经完整，在末尾加上 M2 或 M30，给出 --allow-open-end，或设置程序对象的 OpenEnd</translation>
    </message>
    <message>
        <source>the tool is tilted before G43.4, where the place of its tip depends on another machine</source>
        <translation>刀具在 G43.4 之前已倾斜，此处刀尖的位置取决于另一台机床</translation>
    </message>
    <message>
        <source>check the way there: the next move goes straight to the first place with G43.4; or write G43.4 first</source>
        <translation>检查到那里的路径：下一个移动直接到 G43.4 之后的第一个位置；或先写 G43.4</translation>
    </message>
    <message>
        <source>the orientation of the tool to the tilted plane is unclear here</source>
        <translation>此处不清楚刀具相对倾斜面的方向</translation>
    </message>
    <message>
        <source>write G53.1 directly after G68.2, G69 with the tool retracted, and rotary words of 0 before the next cut</source>
        <translation>紧接 G68.2 之后写 G53.1，退刀后再写 G69，并在下一次切削之前将旋转轴的字写为 0</translation>
    </message>
    <message>
        <source>the tool turns to a tilted plane, where the place of its tip depends on another machine</source>
        <translation>刀具转向倾斜面，此处刀尖的位置取决于另一台机床</translation>
    </message>
    <message>
        <source>check the way there: the next move goes straight to the first place in the plane</source>
        <translation>检查到那里的路径：下一个移动直接到该平面内的第一个位置</translation>
    </message>
    <message>
        <source>a factor of scaling has no decimal point, and counts in units that a parameter of the control sets</source>
        <translation>比例缩放系数没有小数点，其单位由数控系统的参数设定</translation>
    </message>
    <message>
        <source>write it with a point, as in P2. for twice the size</source>
        <translation>写出小数点，例如放大一倍写 P2.</translation>
    </message>
    <message>
        <source>controls differ in what this means while scaling is in force</source>
        <translation>比例缩放有效时，各数控系统对此的解释不同</translation>
    </message>
    <message>
        <source>write G50 before it</source>
        <translation>在其之前写 G50</translation>
    </message>
    <message>
        <source>no move has a known position</source>
        <translation>没有任何移动的位置是已知的</translation>
    </message>
    <message>
        <source>give X, Y and Z in the first moves: a control would begin them wherever the tool stands</source>
        <translation>在最初的移动中给出 X、Y 和 Z：否则数控系统会从刀具当时所在的位置开始</translation>
    </message>
    <message>
        <source>controls differ in whether this code acts before the move of its block or after it</source>
        <translation>此代码在其程序段的移动之前还是之后起作用，各数控系统不同</translation>
    </message>
    <message>
        <source>write it in a block of its own</source>
        <translation>将其写在单独的程序段中</translation>
    </message>
    <message>
        <source>the tool axis tilts, and this form of G-code cannot express it</source>
        <translation>刀轴倾斜，而此 G 代码形式不能表示</translation>
    </message>
    <message>
        <source>choose a form with five axes</source>
        <translation>选择五轴形式</translation>
    </message>
    <message>
        <source>the tool axis points down, and this form of G-code cannot express it</source>
        <translation>刀轴朝下，而此 G 代码形式不能表示</translation>
    </message>
    <message>
        <source>choose vectors or a head</source>
        <translation>选择向量形式或摆头形式</translation>
    </message>
    <message>
        <source>arcs that this form of G-code cannot express are written as lines</source>
        <translation>此 G 代码形式不能表示的圆弧写成了直线</translation>
    </message>
    <message>
        <source>no action is needed</source>
        <translation>无需处理</translation>
    </message>
    <message>
        <source>surface normals cannot be expressed in this form of G-code and are left out</source>
        <translation>曲面法线不能用此 G 代码形式表示，已略去</translation>
    </message>
    <message>
        <source>keep the source of the program</source>
        <translation>保留程序的来源</translation>
    </message>
    <message>
        <source>a control that interpolates these angles linearly swings the tool axis off its programmed path</source>
        <translation>对这些角度作线性插补的数控系统会使刀轴偏离编程路径</translation>
    </message>
    <message>
        <source>divide the moves in the CAM system, or write the tool axis as vectors</source>
        <translation>在 CAM 系统中细分这些移动，或将刀轴写成向量</translation>
    </message>
    <message>
        <source>a feed is so slow that it would be written as zero</source>
        <translation>进给太慢，会被写成零</translation>
    </message>
    <message>
        <source>program a feed of 0.001 a minute at least</source>
        <translation>编程进给至少为每分钟 0.001</translation>
    </message>
    <message>
        <source>the statement is malformed</source>
        <translation>语句的格式错误</translation>
    </message>
    <message>
        <source>write it as the programming manual of the control does; docs/siemens.md lists it</source>
        <translation>按数控系统编程手册的格式书写；docs/siemens.md 列出了各语句</translation>
    </message>
    <message>
        <source>this part of Siemens&apos;s language is not read</source>
        <translation>不读取西门子语言的这一部分</translation>
    </message>
    <message>
        <source>let the CAM system write plain moves and tool axes as vectors</source>
        <translation>让 CAM 系统写出普通移动，刀轴写成向量</translation>
    </message>
    <message>
        <source>the name is not known</source>
        <translation>名称未知</translation>
    </message>
    <message>
        <source>define the variable with DEF, put the subprogram into the file, or remove what is for another machine</source>
        <translation>用 DEF 定义变量，将子程序写入文件，或删除用于其他机床的内容</translation>
    </message>
    <message>
        <source>the jump has no destination in this program</source>
        <translation>跳转在此程序中没有目标</translation>
    </message>
    <message>
        <source>write the label or block number</source>
        <translation>写出标号或程序段号</translation>
    </message>
    <message>
        <source>a loop, branch or subprogram has no matching end</source>
        <translation>循环、分支或子程序没有对应的结束</translation>
    </message>
    <message>
        <source>write it, in the same program</source>
        <translation>在同一程序中写出它</translation>
    </message>
    <message>
        <source>the value is not possible here</source>
        <translation>此处不可能有这个值</translation>
    </message>
    <message>
        <source>rotary words have no meaning here, or several</source>
        <translation>旋转轴的字在此处没有意义，或有多种含义</translation>
    </message>
    <message>
        <source>write the tool axis as a vector, A3= B3= C3=; or give the rotary axes with --axis-words AC, BC or AB, and write them after TRAORI in a frame that is not turned</source>
        <translation>将刀轴写成向量 A3= B3= C3=；或用 --axis-words AC、BC 或 AB 给出旋转轴，并在 TRAORI 之后、未旋转的坐标系中书写</translation>
    </message>
    <message>
        <source>the angles of the tool axis have two readings, Euler angles and RPY angles</source>
        <translation>刀轴的角度有两种读法：欧拉角和 RPY 角</translation>
    </message>
    <message>
        <source>write ORIEULER or ORIRPY before them</source>
        <translation>在其之前写 ORIEULER 或 ORIRPY</translation>
    </message>
    <message>
        <source>the place of this coordinate system is unknown</source>
        <translation>该坐标系的位置未知</translation>
    </message>
    <message>
        <source>write one that its code takes: whole numbers of tools, offsets and turns, no feed, speed or dwell below 0</source>
        <translation>写入代码允许的值：刀具号、偏置号和圈数为整数，进给、转速和暂停不小于 0</translation>
    </message>
    <message>
        <source>give it with --origin, such as G55=X,Y,Z; for SUPA, G53 and G153 give --machine-zero X,Y,Z</source>
        <translation>用 --origin 给出，例如 G55=X,Y,Z；对 SUPA、G53 和 G153 给出 --machine-zero X,Y,Z</translation>
    </message>
    <message>
        <source>the way of the tool while the plane swivels depends on another machine</source>
        <translation>平面摆转时刀具的路径取决于另一台机床</translation>
    </message>
    <message>
        <source>check the way there: the next move goes straight to the first place in the new plane</source>
        <translation>检查到那里的路径：下一个移动直接到新平面内的第一个位置</translation>
    </message>
    <message>
        <source>the file cannot be opened as a FreeCAD document</source>
        <translation>该文件不能作为 FreeCAD 文档打开</translation>
    </message>
    <message>
        <source>check the path, or save the document again</source>
        <translation>检查路径，或重新保存文档</translation>
    </message>
    <message>
        <source>there is no CAM job to post</source>
        <translation>没有可后处理的 CAM 作业</translation>
    </message>
    <message>
        <source>add a Job in the CAM workbench, or name the job with --job</source>
        <translation>在 CAM 工作台中添加作业，或用 --job 指定作业</translation>
    </message>
    <message>
        <source>the command is unknown or not allowed here</source>
        <translation>该命令未知，或不允许用在此处</translation>
    </message>
    <message>
        <source>remove it, or use a G0, G1, G2 or G3 move</source>
        <translation>删除它，或改用 G0、G1、G2 或 G3 移动</translation>
    </message>
    <message>
        <source>an arc in this plane is not supported</source>
        <translation>不支持此平面内的圆弧</translation>
    </message>
    <message>
        <source>use XY-plane arcs (G17), or straight moves</source>
        <translation>使用 XY 平面内的圆弧 (G17)，或改用直线移动</translation>
    </message>
    <message>
        <source>regenerate the operation; the radii must agree to 0.005 mm</source>
        <translation>重新生成该操作；两端半径之差不得超过 0.005 mm</translation>
    </message>
    <message>
        <source>a dress-up or array that does not support tool-axis words contains moves with them</source>
        <translation>不支持刀轴字的修饰或阵列中含有带刀轴字的移动</translation>
    </message>
    <message>
        <source>only some of the cutting moves have a tool axis</source>
        <translation>只有部分切削移动带有刀轴</translation>
    </message>
    <message>
        <source>give every G1 of the operation I J K words</source>
        <translation>为该操作的每个 G1 写出 I J K</translation>
    </message>
    <message>
        <source>the tool axis has no direction</source>
        <translation>刀轴没有方向</translation>
    </message>
    <message>
        <source>give I J K words that are not all zero</source>
        <translation>写出不全为零的 I J K</translation>
    </message>
    <message>
        <source>the operation has no tool controller</source>
        <translation>操作没有刀具控制器</translation>
    </message>
    <message>
        <source>choose a tool controller for it</source>
        <translation>为其选择刀具控制器</translation>
    </message>
    <message>
        <source>the gauge length of the tool is unknown or too long</source>
        <translation>刀具长度（主轴端面到刀尖）未知或过长</translation>
    </message>
    <message>
        <source>enter it under Gauge lengths in the panel of Post to a hexapod, set the property GaugeLength of its tool controller, or pass --tool-length NUMBER=MM</source>
        <translation>在“后处理到六自由度并联机床”面板的“刀具长度”中输入，或设置其刀具控制器的属性 GaugeLength，或给出 --tool-length NUMBER=MM</translation>
    </message>
    <message>
        <source>two tools have the same number</source>
        <translation>两把刀具的编号相同</translation>
    </message>
    <message>
        <source>give every tool controller its own tool number</source>
        <translation>为每个刀具控制器设置各自的刀具编号</translation>
    </message>
    <message>
        <source>rotary words have no meaning on this machine</source>
        <translation>旋转轴的字在此机床上没有意义</translation>
    </message>
    <message>
        <source>give the tool axis as I J K words</source>
        <translation>用 I J K 给出刀轴</translation>
    </message>
    <message>
        <source>the operation could not be computed</source>
        <translation>操作未能计算</translation>
    </message>
    <message>
        <source>repair it in FreeCAD until it recomputes without error</source>
        <translation>在 FreeCAD 中修复它，直到重新计算时没有错误</translation>
    </message>
    <message>
        <source>the job&apos;s options are not valid</source>
        <translation>作业的选项无效</translation>
    </message>
    <message>
        <source>correct the arguments of the post-processor</source>
        <translation>改正后处理器的参数</translation>
    </message>
    <message>
        <source>the tool axis was not of unit length and was normalised</source>
        <translation>刀轴不是单位长度，已归一化</translation>
    </message>
    <message>
        <source>a coordinate of a move is not a finite number</source>
        <translation>移动的一个坐标不是有限的数</translation>
    </message>
    <message>
        <source>regenerate the operation</source>
        <translation>重新生成该操作</translation>
    </message>
    <message>
        <source>a CAM operation cannot represent all of the part program</source>
        <translation>CAM 操作不能表示零件程序的全部内容</translation>
    </message>
    <message>
        <source>post the part program itself</source>
        <translation>直接对零件程序进行后处理</translation>
    </message>
    <message>
        <source>a property of a document object has an invalid value</source>
        <translation>文档对象的一个属性的值无效</translation>
    </message>
    <message>
        <source>the drilling cycle cannot be executed</source>
        <translation>钻孔循环不能执行</translation>
    </message>
    <message>
        <source>correct its words; cycles are drilled along Z (G17), after a move to a known height, in operations without tool-axis words</source>
        <translation>改正其中的字；循环沿 Z 向钻孔 (G17)，须在移动到已知高度之后，并位于不含刀轴字的操作中</translation>
    </message>
    <message>
        <source>correct it if it is not intended; dwells of CAM commands are in seconds</source>
        <translation>如非本意请改正；CAM 命令中的暂停以秒为单位</translation>
    </message>
    <message>
        <source>an option overrides a value of the job or the program</source>
        <translation>一个选项取代了作业或程序中的值</translation>
    </message>
    <message>
        <source>leave the option out if this is not intended</source>
        <translation>如非本意，请去掉该选项</translation>
    </message>
    <message>
        <source>an option gives the length of a tool that does not exist</source>
        <translation>选项给出了不存在的刀具的长度</translation>
    </message>
    <message>
        <source>correct the number of the tool, or leave it out</source>
        <translation>改正刀具编号，或去掉该选项</translation>
    </message>
    <message>
        <source>CAM requests an operation that is not in the job</source>
        <translation>CAM 要求的操作不在作业中</translation>
    </message>
    <message>
        <source>choose among the operations of the job</source>
        <translation>从作业的操作中选择</translation>
    </message>
    <message>
        <source>the active length offset (H) is not that of the tool, and its value is unknown</source>
        <translation>当前的刀具长度补偿 (H) 不是该刀具的，其值未知</translation>
    </message>
    <message>
        <source>pass its value with --tool-length NUMBER=MM; if it holds the length of the tool, pass that length</source>
        <translation>用 --tool-length NUMBER=MM 给出其值；如果其中存的是刀具长度，则给出该长度</translation>
    </message>
    <message>
        <source>the file of the document is damaged</source>
        <translation>文档的文件已损坏</translation>
    </message>
    <message>
        <source>use an intact copy of the document, such as its backup file (.FCBak)</source>
        <translation>使用文档的完好副本，例如其备份文件 (.FCBak)</translation>
    </message>
    <message>
        <source>the content of the document is inconsistent</source>
        <translation>文档的内容前后矛盾</translation>
    </message>
    <message>
        <source>FreeCAD did not read all operations of the job</source>
        <translation>FreeCAD 没有读入作业的全部操作</translation>
    </message>
    <message>
        <source>the path of an active operation is empty</source>
        <translation>一个启用的操作的轨迹为空</translation>
    </message>
    <message>
        <source>an operation is out of date: it or its inputs changed after it was computed</source>
        <translation>一个操作已过时：它或它的输入在计算之后有更改</translation>
    </message>
    <message>
        <source>switch Skip Recomputes off and recompute the document</source>
        <translation>关闭“跳过重新计算”并重新计算文档</translation>
    </message>
    <message>
        <source>FreeCAD could not read the path or another property of an operation</source>
        <translation>FreeCAD 不能读取某个操作的轨迹或其他属性</translation>
    </message>
    <message>
        <source>the path of an operation holds characters that are not UTF-8</source>
        <translation>一个操作的轨迹含有非 UTF-8 字符</translation>
    </message>
    <message>
        <source>remove them from the inputs of the operation, mark it to be recomputed, and recompute the document</source>
        <translation>从该操作的输入中删除这些字符，将其标记为需要重新计算，并重新计算文档</translation>
    </message>
    <message>
        <source>an object among the operations of the job has no path</source>
        <translation>作业的操作中有一个对象没有轨迹</translation>
    </message>
    <message>
        <source>remove it from the operations</source>
        <translation>将其从操作中移除</translation>
    </message>
    <message>
        <source>the document is being recomputed, and the paths of its operations are not complete</source>
        <translation>文档正在重新计算，其操作的轨迹还不完整</translation>
    </message>
    <message>
        <source>wait for the end of the recompute, then post or check again</source>
        <translation>等待重新计算结束，然后再次后处理或检查</translation>
    </message>
    <message>
        <source>see CAM&apos;s message in the Report view; correct its tool, geometry or depths, or deactivate it</source>
        <translation>请查看报告视图中 CAM 的消息；更正其刀具、几何体或深度，或停用它</translation>
    </message>
    <message>
        <source>set SpindleDir of the controller and SpindleDirection of the tool bit alike; for a standing spindle, speed 0</source>
        <translation>将控制器的 SpindleDir 与刀具的 SpindleDirection 设为一致；主轴不转时将转速设为 0</translation>
    </message>
    <message>
        <source>FreeCAD reads the label or comment of an operation as commands when it opens the document</source>
        <translation>FreeCAD 打开文档时会把操作的标签或注释读成命令</translation>
    </message>
    <message>
        <source>write it without ( and ), mark the operation to be recomputed, recompute and save; then open the document again</source>
        <translation>写成不含 ( 和 ) 的文字，将操作标记为需要重新计算，重新计算并保存；然后重新打开文档</translation>
    </message>
    <message>
        <source>CAM leaves out holes, faces or holding tags of an operation</source>
        <translation>CAM 省略了操作的孔、面或支撑标签</translation>
    </message>
    <message>
        <source>see CAM&apos;s message, if any, in the Report view; enable or move them, take a narrower tool, or remove those that are not meant</source>
        <translation>查看报告视图中 CAM 的消息（如果有）；启用或移动它们，换用更细的刀具，或移除不需要的</translation>
    </message>
    <message>
        <source>a strut would be too short</source>
        <translation>一条支链会过短</translation>
    </message>
    <message>
        <source>move or turn the part on the table, or use another tool length; Find a place in the panel of Reach and python3 -m pkm_post reach --place look for one that suffices</source>
        <translation>在工作台上移动或旋转零件，或使用其他长度的刀具；“可达性”面板中的“寻找位置”和 python3 -m pkm_post reach --place 可寻找满足要求的位置</translation>
    </message>
    <message>
        <source>a strut would be too long</source>
        <translation>一条支链会过长</translation>
    </message>
    <message>
        <source>a base joint would swing too far</source>
        <translation>一个底座铰链会摆动过大</translation>
    </message>
    <message>
        <source>tilt the tool less, or move the part; Find a place in the panel of Reach and python3 -m pkm_post reach --place look for one that suffices</source>
        <translation>减小刀具倾斜，或移动零件；“可达性”面板中的“寻找位置”和 python3 -m pkm_post reach --place 可寻找满足要求的位置</translation>
    </message>
    <message>
        <source>a platform joint would swing too far</source>
        <translation>一个动平台铰链会摆动过大</translation>
    </message>
    <message>
        <source>the path comes too close to a singular pose</source>
        <translation>路径离奇异位姿太近</translation>
    </message>
    <message>
        <source>the tool axis turns by half a turn in one move</source>
        <translation>刀轴在一个移动中转动了半周</translation>
    </message>
    <message>
        <source>insert a move that defines the direction of rotation; where the part is turned over, post each side by --side N, with its work offset</source>
        <translation>插入一个确定旋转方向的移动；零件翻面时，用 --side N 及其工件偏置分别对每一面进行后处理</translation>
    </message>
    <message>
        <source>the spindle does not support this speed</source>
        <translation>主轴不支持此转速</translation>
    </message>
    <message>
        <source>program a speed within its limits</source>
        <translation>编程转速应在其极限之内</translation>
    </message>
    <message>
        <source>the work offset is unknown to the machine</source>
        <translation>机床没有这个工件偏置</translation>
    </message>
    <message>
        <source>two fixtures of the job are in the same place</source>
        <translation>作业的两个工件坐标系位于同一位置</translation>
    </message>
    <message>
        <source>the trajectory has threads, which are neither played nor stepped through block by block</source>
        <translation>轨迹中有螺纹,螺纹既不能播放,也不能单段运行</translation>
    </message>
    <message>
        <source>run its motion program: pmac run, or Load and Start of the panel</source>
        <translation>运行其运动程序:pmac run,或面板的“装入”和“启动”</translation>
    </message>
    <message>
        <source>a change at the machine does not fit the program</source>
        <translation>在机床上所作的更改与程序不符</translation>
    </message>
    <message>
        <source>name tools of the program; where an arc follows a change of a tool in its place, post again with the new length</source>
        <translation>请指定程序中的刀具；若原位换刀之后紧接圆弧，请以新的长度重新进行后处理</translation>
    </message>
    <message>
        <source>give them names that differ in letters or digits, not in case or an ending such as -setup, or post to different folders</source>
        <translation>为其取字母或数字不同的名称，不能只是大小写不同或 -setup 之类的结尾不同，或后处理到不同的文件夹</translation>
    </message>
    <message>
        <source>choose another name or folder for the result</source>
        <translation>为结果选择其他名称或文件夹</translation>
    </message>
    <message>
        <source>the encoding of the file is not read</source>
        <translation>不支持该文件的编码</translation>
    </message>
    <message>
        <source>save it as UTF-8 text</source>
        <translation>将其另存为 UTF-8 文本</translation>
    </message>
    <message>
        <source>a FreeCAD document is read only inside FreeCAD</source>
        <translation>FreeCAD 文档只能在 FreeCAD 中读取</translation>
    </message>
    <message>
        <source>files with this ending are not read</source>
        <translation>不支持此扩展名的文件</translation>
    </message>
    <message>
        <source>name a motion program as it was posted, of printable ASCII in lines that end with LF or CR LF, or post the job again</source>
        <translation>请指定后处理得到的运动程序（可打印 ASCII，各行以 LF 或 CR LF 结尾），或重新后处理该作业</translation>
    </message>
    <message>
        <source>take a shorter one for --segment-time and SegMoveTime against deviations and jerk, more tolerance against deviations, a dwell where the tool stops without a code, or 0, which is no segmentation; the faults that follow are those of the motion in segments</source>
        <translation>针对偏差和加加速度，为 --segment-time 和 SegMoveTime 取更短的时间；针对偏差，放宽公差；在没有代码而停止之处编入暂停；或取 0，即不分段；以下是分段运动的错误</translation>
    </message>
    <message>
        <source>give a direction and a distance, or a code that switches, such as M3 or M8</source>
        <translation>给出方向和距离，或给出有开关作用的代码，例如 M3 或 M8</translation>
    </message>
    <message>
        <source>no controller answers as expected</source>
        <translation>没有控制器按预期应答</translation>
    </message>
    <message>
        <source>check power, cable, address and port, --baud and --parity, and that no other program has the port open</source>
        <translation>检查电源、电缆、地址和端口、--baud 和 --parity，并确认没有其他程序占用该端口</translation>
    </message>
    <message>
        <source>the computer at this address does not prove that it is the controller</source>
        <translation>该地址上的计算机不能证明自己是控制器</translation>
    </message>
    <message>
        <source>check the address; if the host key is the controller&apos;s, add it: ssh-keyscan -p PORT HOST &gt;&gt;FILE, and --known-hosts FILE</source>
        <translation>检查地址；如果主机密钥确是控制器的，则添加它：ssh-keyscan -p PORT HOST &gt;&gt;FILE，并使用 --known-hosts FILE</translation>
    </message>
    <message>
        <source>the computer of the controller denies access</source>
        <translation>控制器的计算机拒绝访问</translation>
    </message>
    <message>
        <source>offer a key, by an agent or in ~/.ssh, or the password in PKM_PMAC_PASSWORD</source>
        <translation>提供密钥（通过代理或在 ~/.ssh 中），或在 PKM_PMAC_PASSWORD 中提供密码</translation>
    </message>
    <message>
        <source>the code is not supported in a line that is entered by hand</source>
        <translation>手动输入的行不支持该代码</translation>
    </message>
    <message>
        <source>use others; M codes that the controller is to get belong in controller.codes.functions of the machine file</source>
        <translation>使用其他代码；要发送给控制器的 M 代码应写在机床文件的 controller.codes.functions 中</translation>
    </message>
    <message>
        <source>a cutting move that is entered by hand has no feed</source>
        <translation>手动输入的切削移动没有进给速度</translation>
    </message>
    <message>
        <source>write F above zero in the line</source>
        <translation>在该行中写入大于零的 F</translation>
    </message>
    <message>
        <source>set it in the machine file: under work_offsets, or for the machine&apos;s zero in part_programs.machine_zero</source>
        <translation>在机床文件中设定：写在 work_offsets 下，机床零点则写在 part_programs.machine_zero 中</translation>
    </message>
    <message>
        <source>cutter compensation needs the diameter of the tool</source>
        <translation>刀具半径补偿需要刀具直径</translation>
    </message>
    <message>
        <source>write the diameter as D, after G41.1 or G42.1</source>
        <translation>在 G41.1 或 G42.1 之后用 D 写出直径</translation>
    </message>
    <message>
        <source>the jog leads out of the machine&apos;s reach</source>
        <translation>点动超出机床的可达范围</translation>
    </message>
    <message>
        <source>jog less far, or in another direction</source>
        <translation>请点动较短的距离，或换一个方向</translation>
    </message>
    <message>
        <source>give the file the ending of its kind</source>
        <translation>为文件取与其类型相符的扩展名</translation>
    </message>
    <message>
        <source>let no other post write into the folder at the same time, and nothing else remove its files, and post again</source>
        <translation>不要让其他后处理同时写入该文件夹，也不要让其他程序删除其中的文件，然后重新后处理</translation>
    </message>
    <message>
        <source>a process that posts a file did not run to its end</source>
        <translation>一个后处理文件的进程未能运行到结束</translation>
    </message>
    <message>
        <source>start fewer at a time with --jobs, as memory or another limit may be short, and post again</source>
        <translation>内存或其他限额可能不足：用 --jobs 减少同时启动的数量，然后重新后处理</translation>
    </message>
    <message>
        <source>another program of the file is not read</source>
        <translation>文件中的另一个程序未被读取</translation>
    </message>
    <message>
        <source>put it into a file of its own to post it</source>
        <translation>请将其放入单独的文件再进行后处理</translation>
    </message>
    <message>
        <source>write a whole number that is not negative, or a name in &lt; &gt;, and its keyword</source>
        <translation>写出非负整数，或 &lt; &gt; 中的名称，并写出其关键字</translation>
    </message>
    <message>
        <source>write the program without it; an M code that does not move the tool can be left out with --leave-out</source>
        <translation>编写不含它的程序；不移动刀具的 M 代码可用 --leave-out 略去</translation>
    </message>
    <message>
        <source>write each code in a block of its own, with its words; @ and ^ without X and Y</source>
        <translation>每个代码及其字各写一个程序段；@ 和 ^ 不与 X、Y 同写</translation>
    </message>
    <message>
        <source>tapping needs a feed synchronised with the spindle, which is not supported here</source>
        <translation>攻丝需要与主轴同步的进给,此处不支持</translation>
    </message>
    <message>
        <source>controls forbid this while a rotation or mirror image is in force, or differ in where it leads</source>
        <translation>旋转有效时，数控系统禁止此指令，或对其到达的位置解释不同</translation>
    </message>
    <message>
        <source>write G69 or G50.1 before it, and G68 or G51.1 again after it</source>
        <translation>在其之前写 G69，之后再写 G68</translation>
    </message>
    <message>
        <source>the axis words have no motion to apply to</source>
        <translation>坐标字没有可用的运动代码</translation>
    </message>
    <message>
        <source>make G0 or G1 the motion of the block</source>
        <translation>该程序段的运动代码应为 G0 或 G1</translation>
    </message>
    <message>
        <source>controls differ in whether this is incremental under G91</source>
        <translation>在 G91 下，各数控系统对此是否按增量移动的解释不同</translation>
    </message>
    <message>
        <source>write G90 before it</source>
        <translation>在其之前写 G90</translation>
    </message>
    <message>
        <source>a cycle needs a feed, which inverse time does not give</source>
        <translation>循环需要进给速度，而反比时间不给出进给速度</translation>
    </message>
    <message>
        <source>write G94 and F before it</source>
        <translation>在其之前写 G94 和 F</translation>
    </message>
    <message>
        <source>controls differ in which tool this loads, that of an earlier T or that of its block</source>
        <translation>各控制器在此换上的刀具不同：先前 T 的刀具，或本程序段 T 的刀具</translation>
    </message>
    <message>
        <source>write T in a block of its own: before M6 that of the tool to load, after it that of the next one</source>
        <translation>将 T 单独写成一个程序段：M6 之前写要换上的刀具，之后写下一把刀具</translation>
    </message>
    <message>
        <source>the tool is still tilted, and the place to which this moves its tip depends on another machine: it is left out</source>
        <translation>刀具仍然倾斜，此移动使刀尖到达的位置取决于另一台机床：该移动被省略</translation>
    </message>
    <message>
        <source>check the way there: the next move goes straight to the next known place; or retract in the plane, before G69</source>
        <translation>检查到那里的路径：下一个移动直接到下一个已知位置；或在 G69 之前于该平面内退刀</translation>
    </message>
    <message>
        <source>write one of the type and in the range that is needed here</source>
        <translation>写入此处所需类型和范围内的值</translation>
    </message>
    <message>
        <source>the job has no active operation that moves the tool</source>
        <translation>作业中没有使刀具移动的启用的操作</translation>
    </message>
    <message>
        <source>set a feed above zero in the tool controller</source>
        <translation>在刀具控制器中设置大于零的进给速度</translation>
    </message>
    <message>
        <source>remove it, or apply it to an operation without tool-axis words; Rotate operation makes copies around an axis</source>
        <translation>删除该修饰或阵列，或将其用于不含刀轴字的操作；绕轴的副本由“旋转操作”生成</translation>
    </message>
    <message>
        <source>give the second one its own with --origin NAME=X,Y,Z</source>
        <translation>用 --origin NAME=X,Y,Z 为第二个给出其自己的位置</translation>
    </message>
    <message>
        <source>correct it in the property editor</source>
        <translation>在属性编辑器中改正</translation>
    </message>
    <message>
        <source>recompute the operation and correct what CAM says of it in the Report view, or deactivate it</source>
        <translation>重新计算该操作，并按报告视图中 CAM 的消息进行更正，或停用该操作</translation>
    </message>
    <message>
        <source>an option gives the place of a fixture that the job does not have, or has as its first one</source>
        <translation>选项给出了一个工件坐标系的位置，而作业没有该坐标系，或它是作业的第一个</translation>
    </message>
    <message>
        <source>correct its name, or leave it out; the first fixture is where --work-offset puts it</source>
        <translation>改正其名称，或去掉该选项；第一个工件坐标系位于 --work-offset 指定的位置</translation>
    </message>
    <message>
        <source>a job with several fixtures is to be copied as a whole</source>
        <translation>有多个工件坐标系的作业要整体复制</translation>
    </message>
    <message>
        <source>make the copies in the job, as operations of Mirror or Rotate, or leave --copies out</source>
        <translation>在作业中用“镜像操作”或“旋转操作”生成副本，或去掉 --copies</translation>
    </message>
    <message>
        <source>Split Output of the job is not followed: one program holds all of it</source>
        <translation>未按作业的“拆分输出”执行：一个程序包含全部内容</translation>
    </message>
    <message>
        <source>deactivate operations, or take fixtures out of the job, to post a part of it</source>
        <translation>如只需后处理其中一部分，请停用部分操作，或从作业中移除部分夹具</translation>
    </message>
    <message>
        <source>CAM computed an active operation without a cutting move</source>
        <translation>CAM 计算出的一个启用的操作没有切削运动</translation>
    </message>
    <message>
        <source>probing is not part of a program, which is computed before it runs</source>
        <translation>程序在运行前已计算完成，不能包含探测</translation>
    </message>
    <message>
        <source>deactivate the operation; pkm-post pmac measure probes between programs</source>
        <translation>停用该操作；pkm-post pmac measure 可在程序之间进行探测</translation>
    </message>
    <message>
        <source>the tool controller and its tool bit turn the spindle in different directions</source>
        <translation>刀具控制器与其刀具使主轴沿不同方向旋转</translation>
    </message>
    <message>
        <source>each command needs one code, at its start</source>
        <translation>每条命令需要一个代码，位于其开头</translation>
    </message>
    <message>
        <source>write G1 Y5 for Y5 and M3 S9000 for S9000, and a second code on a line of its own</source>
        <translation>Y5 应写作 G1 Y5，S9000 应写作 M3 S9000，第二个代码另起一行</translation>
    </message>
    <message>
        <source>a state that an operation switched is reset at the next one</source>
        <translation>一个操作所切换的状态在下一个操作处恢复</translation>
    </message>
    <message>
        <source>set the speed in a tool controller and CoolantMode in the operation, or repeat the code there</source>
        <translation>在刀具控制器中设置转速，在操作中设置 CoolantMode，或在该处重复此代码</translation>
    </message>
    <message>
        <source>FreeCAD reads a line of a Custom operation as something else, or leaves it out</source>
        <translation>FreeCAD 把自定义操作的某一行读成了别的内容，或略去了它</translation>
    </message>
    <message>
        <source>write one code and its words, with decimal points, and a comment in ( ) on a line of its own; recompute</source>
        <translation>每行写一个代码及其字，小数用小数点，( ) 中的注释单独成行；然后重新计算</translation>
    </message>
    <message>
        <source>several CAM jobs may be meant</source>
        <translation>可能指多个 CAM 作业</translation>
    </message>
    <message>
        <source>name one with --job by a label or name that no other job has; change a label in FreeCAD if there is none</source>
        <translation>用 --job 以其他作业没有的标签或名称指定一个；若没有这样的，请在 FreeCAD 中更改标签</translation>
    </message>
    <message>
        <source>the stock has changed since CAM computed the operation</source>
        <translation>毛坯在 CAM 计算该操作之后已更改</translation>
    </message>
    <message>
        <source>mark the operation to be recomputed, and recompute; then look at its depths and its path</source>
        <translation>将该操作标记为重新计算并执行重新计算，然后检查其深度和路径</translation>
    </message>
    <message>
        <source>the path of the operation is not the one that CAM computes for the present model and stock</source>
        <translation>该操作的轨迹不是 CAM 按当前模型和毛坯计算的轨迹</translation>
    </message>
    <message>
        <source>add it to the machine file, or pass --work-offset, or --origin for a further fixture of a CAM job</source>
        <translation>将其加入机床文件，或给出 --work-offset；CAM 作业的其他工件坐标系用 --origin 给出</translation>
    </message>
    <message>
        <source>the matrix is not a rotation, a mirror or a shift</source>
        <translation>该矩阵不是旋转、镜像或平移</translation>
    </message>
    <message>
        <source>use a matrix without scale or shear</source>
        <translation>使用没有缩放和剪切的矩阵</translation>
    </message>
    <message>
        <source>the feed is beyond the machine and is limited</source>
        <translation>进给超出机床的能力，已受限制</translation>
    </message>
    <message>
        <source>program a feed that the machine can run</source>
        <translation>编程进给应为机床能够达到的进给</translation>
    </message>
    <message>
        <source>cutter compensation would leave its plane</source>
        <translation>刀具半径补偿会离开其平面</translation>
    </message>
    <message>
        <source>compensate before the path is turned or mirrored</source>
        <translation>在旋转或镜像轨迹之前进行补偿</translation>
    </message>
    <message>
        <source>two struts come too close to each other</source>
        <translation>两条支链相距太近</translation>
    </message>
    <message>
        <source>turn the platform about the tool axis, or move the part</source>
        <translation>使动平台绕刀轴转动，或移动零件</translation>
    </message>
    <message>
        <source>a strut comes too close to the spindle or its platform</source>
        <translation>一条支链离主轴或其动平台太近</translation>
    </message>
    <message>
        <source>tilt the tool less, or turn the platform</source>
        <translation>减小刀具倾斜，或转动动平台</translation>
    </message>
    <message>
        <source>a strut comes too close to an object on the table</source>
        <translation>一条支链离工作台上的物体太近</translation>
    </message>
    <message>
        <source>move the part or the fixture</source>
        <translation>移动零件或夹具</translation>
    </message>
    <message>
        <source>the spindle or holder comes too close to an object on the table</source>
        <translation>主轴或刀柄离工作台上的物体太近</translation>
    </message>
    <message>
        <source>use a longer tool, or tilt it</source>
        <translation>使用更长的刀具，或使其倾斜</translation>
    </message>
    <message>
        <source>the spindle or holder comes too close to the part</source>
        <translation>主轴或刀柄离零件太近</translation>
    </message>
    <message>
        <source>a strut cannot keep up with the feed, and the tool will be slower</source>
        <translation>一条支链跟不上进给，刀具会变慢</translation>
    </message>
    <message>
        <source>program a lower feed</source>
        <translation>降低编程进给</translation>
    </message>
    <message>
        <source>the machine is too compliant along the surface normal</source>
        <translation>机床沿曲面法向的刚度太低</translation>
    </message>
    <message>
        <source>tilt the tool less, or move the part</source>
        <translation>减小刀具倾斜，或移动零件</translation>
    </message>
    <message>
        <source>the tool axis is perpendicular to the plane of the spin rule</source>
        <translation>刀轴垂直于自转角规则的平面</translation>
    </message>
    <message>
        <source>choose another spin</source>
        <translation>选择其他自转角</translation>
    </message>
    <message>
        <source>a strut comes too close to the part</source>
        <translation>一条支链离零件太近</translation>
    </message>
    <message>
        <source>move or turn the part on the table</source>
        <translation>在工作台上移动或旋转零件</translation>
    </message>
    <message>
        <source>a pass cannot be reversed: its approach and retract moves are unknown</source>
        <translation>一次走刀不能反向：其进刀和退刀移动未知</translation>
    </message>
    <message>
        <source>lift the tool along its axis between the passes, or do without climb milling</source>
        <translation>在各次走刀之间沿刀轴抬刀，或不保持顺铣</translation>
    </message>
    <message>
        <source>the path begins with a rapid move to a point in the material, where the original ends</source>
        <translation>轨迹以快速移动开始，移到材料中原操作结束的点</translation>
    </message>
    <message>
        <source>check that the point is free, or lift the tool along its axis at the end of the original</source>
        <translation>确认该点没有材料，或在原操作结束时沿刀轴抬刀</translation>
    </message>
    <message>
        <source>a reversed pass begins at its deep end</source>
        <translation>反向的走刀从其较深的一端开始</translation>
    </message>
    <message>
        <source>check that the cutter can start there</source>
        <translation>确认刀具可以从那里开始</translation>
    </message>
    <message>
        <source>an event lies within a pass that is to be reversed</source>
        <translation>要反向的走刀中有一个事件</translation>
    </message>
    <message>
        <source>move it between the passes, or do without climb milling</source>
        <translation>将其移到各次走刀之间，或不保持顺铣</translation>
    </message>
    <message>
        <source>an arc begins at a change to a tool of another length</source>
        <translation>圆弧从更换为另一长度刀具之处开始</translation>
    </message>
    <message>
        <source>make a straight move before the arc</source>
        <translation>在圆弧之前做一个直线移动</translation>
    </message>
    <message>
        <source>a move takes longer than a day</source>
        <translation>一个移动超过一天</translation>
    </message>
    <message>
        <source>give it a higher feed</source>
        <translation>为其给出更高的进给</translation>
    </message>
    <message>
        <source>a strut cannot keep up with a rapid move, and the tool will be slower there</source>
        <translation>一条支链跟不上快速移动，刀具在那里会变慢</translation>
    </message>
    <message>
        <source>nothing has to be done, the move takes longer; tool_path.rapid_speed of the machine file is the speed of rapid moves</source>
        <translation>无需处理，只是该移动用时更长；快速移动的速度是机床文件的 tool_path.rapid_speed</translation>
    </message>
    <message>
        <source>the shank of the tool goes into the part</source>
        <translation>刀杆进入零件</translation>
    </message>
    <message>
        <source>use a tool with longer cutting edges or a thinner shank, or tilt it</source>
        <translation>使用切削刃更长或刀杆更细的刀具，或使其倾斜</translation>
    </message>
    <message>
        <source>a rapid move takes the cutter through the part</source>
        <translation>快速移动使刀具穿过零件</translation>
    </message>
    <message>
        <source>raise the clearance and retract heights of the operation</source>
        <translation>提高该操作的安全高度和退刀高度</translation>
    </message>
    <message>
        <source>the cutter goes deeper into the part than its surface</source>
        <translation>刀具切入零件，低于其表面</translation>
    </message>
    <message>
        <source>check the depths and the flank of the cutter</source>
        <translation>检查深度，以及刀具侧刃的切削</translation>
    </message>
    <message>
        <source>the tool or the machine comes too close to a fixture</source>
        <translation>刀具或机床离夹具太近</translation>
    </message>
    <message>
        <source>move the fixture or the path, or use a longer tool</source>
        <translation>移动夹具或轨迹，或使用更长的刀具</translation>
    </message>
    <message>
        <source>a body other than the cutter enters uncut stock</source>
        <translation>刀具切削部分以外的物体进入未切除的毛坯</translation>
    </message>
    <message>
        <source>rough the part before, use a longer tool, or give the stock as it is before the first operation</source>
        <translation>先对零件粗加工，使用更长的刀具，或给出第一个操作之前的毛坯</translation>
    </message>
    <message>
        <source>a body other than the cutter enters stock that may still be there</source>
        <translation>刀具切削部分以外的物体进入可能尚未切除的毛坯</translation>
    </message>
    <message>
        <source>check that it is cut before, or give the stock as it is before the first operation</source>
        <translation>确认其已先被切除，或给出第一个操作之前的毛坯</translation>
    </message>
    <message>
        <source>a rapid move goes through uncut stock</source>
        <translation>快速移动穿过未切除的毛坯</translation>
    </message>
    <message>
        <source>raise the clearance and retract heights, or give the stock as it is before the first operation</source>
        <translation>提高安全高度和退刀高度，或给出第一个操作之前的毛坯</translation>
    </message>
    <message>
        <source>a rapid move goes through stock that may still be there</source>
        <translation>快速移动穿过可能尚未切除的毛坯</translation>
    </message>
    <message>
        <source>the solid cannot be read</source>
        <translation>实体不能读取</translation>
    </message>
    <message>
        <source>write it as an STL file, ASCII or binary, in mm and in work coordinates, or as STEP where FreeCAD is installed</source>
        <translation>写成 STL 文件（ASCII 或二进制，单位 mm，工件坐标），安装了 FreeCAD 时也可用 STEP</translation>
    </message>
    <message>
        <source>the mesh of the stock is not closed, and only its surface is checked</source>
        <translation>毛坯的网格不封闭，只检查其表面</translation>
    </message>
    <message>
        <source>write a closed solid as STL</source>
        <translation>将封闭的实体写成 STL</translation>
    </message>
    <message>
        <source>the tool is larger than the spindle accepts</source>
        <translation>刀具超过主轴允许的尺寸</translation>
    </message>
    <message>
        <source>use a smaller tool, or correct spindle.largest_tool_diameter or spindle.longest_tool of the machine file</source>
        <translation>使用更小的刀具，或改正机床文件的 spindle.largest_tool_diameter 或 spindle.longest_tool</translation>
    </message>
    <message>
        <source>the tip of a tool would be below the safe height at the tool-change pose</source>
        <translation>在换刀位姿处，一把刀具的刀尖会低于安全高度</translation>
    </message>
    <message>
        <source>raise tool_change.nose, lower tool_change.safe_height, or use a shorter tool</source>
        <translation>提高 tool_change.nose，降低 tool_change.safe_height，或使用更短的刀具</translation>
    </message>
    <message>
        <source>the tool is tilted too far to be retracted along its axis to the safe height</source>
        <translation>刀具倾斜太大，不能沿其轴线退到安全高度</translation>
    </message>
    <message>
        <source>tilt the tool less before the tool change and after it</source>
        <translation>在换刀前后减小刀具倾斜</translation>
    </message>
    <message>
        <source>the program cuts after a tool change without starting the spindle</source>
        <translation>程序在换刀后未启动主轴就切削</translation>
    </message>
    <message>
        <source>start the spindle with M3 or M4 between the tool change and the cut</source>
        <translation>在换刀与切削之间用 M3 或 M4 启动主轴</translation>
    </message>
    <message>
        <source>the diameter of a tool is unknown, and the limit of the spindle is not checked</source>
        <translation>一把刀具的直径未知，未检查主轴的极限</translation>
    </message>
    <message>
        <source>give the diameter: --tool NUMBER=D for G-code, the tool of the CAM job, or the tool statement of CL data</source>
        <translation>给出直径：G 代码用 --tool NUMBER=D，CAM 作业用其刀具，CL 数据用刀具语句</translation>
    </message>
    <message>
        <source>the motion takes longer than can be planned</source>
        <translation>运动用时过长，不能规划</translation>
    </message>
    <message>
        <source>raise the feeds, or the speeds and accelerations of the machine file; or post fewer operations at a time</source>
        <translation>提高进给，或提高机床文件的速度和加速度；或每次对较少的操作进行后处理</translation>
    </message>
    <message>
        <source>the tolerance of a move is too small</source>
        <translation>一个移动的公差太小</translation>
    </message>
    <message>
        <source>raise P of its G64, or leave P out</source>
        <translation>增大其 G64 的 P，或不写 P</translation>
    </message>
    <message>
        <source>the platform is turned too far about the tool axis</source>
        <translation>动平台绕刀轴转动过大</translation>
    </message>
    <message>
        <source>write the spin within a few turns</source>
        <translation>自转角应写在几周之内</translation>
    </message>
    <message>
        <source>a copy of the program would be reached by a feed move</source>
        <translation>程序的一个副本会由进给移动到达</translation>
    </message>
    <message>
        <source>begin the program with a rapid move (G0, RAPID) above the part</source>
        <translation>程序应以到零件上方的快速移动（G0、RAPID）开始</translation>
    </message>
    <message>
        <source>an operation has the name of moves that are added for tool changes</source>
        <translation>操作的名称与为换刀添加的移动的名称相同</translation>
    </message>
    <message>
        <source>give the operation another name</source>
        <translation>为该操作另取名称</translation>
    </message>
    <message>
        <source>the program has no line to begin at</source>
        <translation>程序没有可以开始的行</translation>
    </message>
    <message>
        <source>name a line up to the last one that moves, and its operation: --from-line OPERATION:N</source>
        <translation>指定不超过最后一个移动的行及其操作：--from-line OPERATION:N</translation>
    </message>
    <message>
        <source>the tool is tilted too far to come down to the line along its axis</source>
        <translation>刀具倾斜太大，不能沿其轴线下到该行</translation>
    </message>
    <message>
        <source>begin at an earlier line, where it is tilted less</source>
        <translation>从刀具倾斜较小的较前一行开始</translation>
    </message>
    <message>
        <source>M codes of the machine before the line are not repeated</source>
        <translation>该行之前的机床 M 代码不会重复执行</translation>
    </message>
    <message>
        <source>bring the machine into the state that they left it in, repeat them with --repeat-codes, or begin at an earlier line</source>
        <translation>使机床处于这些代码之后的状态，用 --repeat-codes 重复它们，或从较前一行开始</translation>
    </message>
    <message>
        <source>the program has no such side</source>
        <translation>程序没有这一面</translation>
    </message>
    <message>
        <source>name one of its sides, counted from 1: --side N</source>
        <translation>指定其中一面，从 1 开始计数：--side N</translation>
    </message>
    <message>
        <source>a thread needs a spindle that is an axis, and the machine file states none</source>
        <translation>螺纹需要可作为轴的主轴,而机床文件中没有写明</translation>
    </message>
    <message>
        <source>state [spindle.axis] and its codes in the machine file if the spindle is one, or mill the threads as helices</source>
        <translation>如果主轴可作为轴,在机床文件中写明 [spindle.axis] 及其代码,或用螺旋线铣削螺纹</translation>
    </message>
    <message>
        <source>a thread is not made of feed moves along the tool axis</source>
        <translation>螺纹不是由沿刀轴的进给移动组成的</translation>
    </message>
    <message>
        <source>tap along the tool axis</source>
        <translation>沿刀轴攻丝</translation>
    </message>
    <message>
        <source>the spindle as an axis cannot keep up with the feed of a thread, and the thread will be slower</source>
        <translation>作为轴的主轴跟不上螺纹的进给,螺纹将加工得较慢</translation>
    </message>
    <message>
        <source>nothing has to be done, the lead is kept; a lower spindle speed of the thread has the same effect</source>
        <translation>无需处理,导程保持不变;降低螺纹的主轴转速效果相同</translation>
    </message>
    <message>
        <source>threads cannot be tapped in this way</source>
        <translation>不能以这种方式攻丝</translation>
    </message>
    <message>
        <source>leave that option out, or post the threads as a program of their own</source>
        <translation>去掉该选项,或将螺纹单独后处理为一个程序</translation>
    </message>
    <message>
        <source>the machine file states no stiffness of the struts</source>
        <translation>机床文件没有说明支链的刚度</translation>
    </message>
    <message>
        <source>state struts.stiffness in it, and struts.rigidity where screws are long</source>
        <translation>请在其中写明 struts.stiffness；丝杠较长时再写明 struts.rigidity</translation>
    </message>
    <message>
        <source>the tool would point straight up, where its spin is not defined</source>
        <translation>刀具会垂直朝上，此处自转角没有定义</translation>
    </message>
    <message>
        <source>turn the part over, and post what is cut from below as a program of its own</source>
        <translation>请将工件翻面，并把从下方加工的部分作为单独的程序后处理</translation>
    </message>
    <message>
        <source>corners between short lines slow the tool</source>
        <translation>短直线之间的拐角使刀具减速</translation>
    </message>
    <message>
        <source>request the tolerance shown if the part allows it: --tip-tolerance and --axis-tolerance, or in the panel; or let the CAM system compute its points more closely</source>
        <translation>如果零件允许，请要求所示的公差：--tip-tolerance 和 --axis-tolerance，或在面板中输入；或者让 CAM 系统更精密地计算刀位点</translation>
    </message>
    <message>
        <source>remove it, or put the text into a comment after $$</source>
        <translation>删除它，或将文字放入 $$ 之后的注释</translation>
    </message>
    <message>
        <source>write it as -12.5 or 1.0E-05</source>
        <translation>写成 -12.5 或 1.0E-05 的形式</translation>
    </message>
    <message>
        <source>a statement is too long</source>
        <translation>语句太长</translation>
    </message>
    <message>
        <source>split it</source>
        <translation>将其拆开</translation>
    </message>
    <message>
        <source>a text in quotes is not closed</source>
        <translation>引号中的文字没有结束</translation>
    </message>
    <message>
        <source>close it on the same line</source>
        <translation>在同一行内结束它</translation>
    </message>
    <message>
        <source>a $ is inside a line</source>
        <translation>$ 位于行的中间</translation>
    </message>
    <message>
        <source>put $ at the end of a line that is continued, $$ before a comment</source>
        <translation>$ 写在续行的行末，$$ 写在注释之前</translation>
    </message>
    <message>
        <source>a statement does not begin with a word</source>
        <translation>语句没有以词开头</translation>
    </message>
    <message>
        <source>begin it with its major word, such as GOTO</source>
        <translation>以其主词开头，例如 GOTO</translation>
    </message>
    <message>
        <source>unexpected text in the statement</source>
        <translation>语句中有意外的文字</translation>
    </message>
    <message>
        <source>write WORD/item,item,... on a line of its own</source>
        <translation>另起一行写成 WORD/item,item,... 的形式</translation>
    </message>
    <message>
        <source>a parenthesis is not closed</source>
        <translation>圆括号没有结束</translation>
    </message>
    <message>
        <source>close it with )</source>
        <translation>用 ) 结束</translation>
    </message>
    <message>
        <source>a closing parenthesis has no opening one</source>
        <translation>右括号没有对应的左括号</translation>
    </message>
    <message>
        <source>remove it, or add the opening one</source>
        <translation>删除它，或补上左括号</translation>
    </message>
    <message>
        <source>parentheses are nested too deeply</source>
        <translation>圆括号嵌套过深</translation>
    </message>
    <message>
        <source>write the statement without them</source>
        <translation>写出不含圆括号的语句</translation>
    </message>
    <message>
        <source>the statement is not supported</source>
        <translation>不支持该语句</translation>
    </message>
    <message>
        <source>let the CAM system write the motion in plain points and arcs</source>
        <translation>让 CAM 系统用普通的点和圆弧写出运动</translation>
    </message>
    <message>
        <source>the items of the statement are not valid</source>
        <translation>语句的项无效</translation>
    </message>
    <message>
        <source>give it the items described in docs/cl-data.md</source>
        <translation>按 docs/cl-data.md 所述写出各项</translation>
    </message>
    <message>
        <source>a value is not possible</source>
        <translation>不可能有这个值</translation>
    </message>
    <message>
        <source>write one that the statement takes: no feed or length below 0; feeds per turn need a speed before them</source>
        <translation>写入语句允许的值：进给和长度不小于 0；每转进给之前需要有转速</translation>
    </message>
    <message>
        <source>the word is unknown and was ignored</source>
        <translation>词未知，已忽略</translation>
    </message>
    <message>
        <source>check that the job does not need it</source>
        <translation>确认作业不需要它</translation>
    </message>
    <message>
        <source>give I, J and K, not all zero</source>
        <translation>给出不全为零的 I、J 和 K</translation>
    </message>
    <message>
        <source>write FEDRAT before it, or give --feed</source>
        <translation>在其之前写 FEDRAT，或给出 --feed</translation>
    </message>
    <message>
        <source>regenerate the path; the radii must agree to 0.05 mm</source>
        <translation>重新生成轨迹；两端半径之差不得超过 0.05 mm</translation>
    </message>
    <message>
        <source>the arc fits its end points badly</source>
        <translation>圆弧与其端点吻合较差</translation>
    </message>
    <message>
        <source>write more decimals; the radii should agree to 0.0005 mm</source>
        <translation>写出更多小数；两端半径之差应不超过 0.0005 mm</translation>
    </message>
    <message>
        <source>the unit of length is uncertain</source>
        <translation>长度单位不确定</translation>
    </message>
    <message>
        <source>check the size of the part, and give --unit mm or --unit inch</source>
        <translation>检查零件的大小，并给出 --unit mm 或 --unit inch</translation>
    </message>
    <message>
        <source>the gauge length of the tool is unknown; 0 is used</source>
        <translation>刀具长度（主轴端面到刀尖）未知，按 0 处理</translation>
    </message>
    <message>
        <source>give the tool with its length</source>
        <translation>给出带长度的刀具</translation>
    </message>
    <message>
        <source>correct its items, or let the CAM system write single moves</source>
        <translation>改正其各项，或让 CAM 系统写出逐个移动</translation>
    </message>
    <message>
        <source>the file contains no motion</source>
        <translation>文件中没有运动</translation>
    </message>
    <message>
        <source>an arc has no end point</source>
        <translation>圆弧没有终点</translation>
    </message>
    <message>
        <source>write GOTO after it</source>
        <translation>在其后写 GOTO</translation>
    </message>
    <message>
        <source>statements after FINI were ignored</source>
        <translation>FINI 之后的语句已忽略</translation>
    </message>
    <message>
        <source>remove them, or remove FINI</source>
        <translation>删除这些语句，或删除 FINI</translation>
    </message>
    <message>
        <source>an inverse time feed needs a move of non-zero length</source>
        <translation>反比时间进给需要长度不为零的移动</translation>
    </message>
    <message>
        <source>give such moves a feed in mm/min</source>
        <translation>为这样的移动给出以 mm/min 为单位的进给</translation>
    </message>
    <message>
        <source>write FROM or GOTO first</source>
        <translation>先写 FROM 或 GOTO</translation>
    </message>
    <message>
        <source>e and f do not put the corner of the cutter against its bottom and side, and were ignored</source>
        <translation>e 和 f 不能使刀具圆角与其底面和侧面相接，已忽略</translation>
    </message>
    <message>
        <source>write the e and f of a corner that touches both, or leave them out</source>
        <translation>写出与两者都相接的圆角的 e 和 f，或将其略去</translation>
    </message>
    <message>
        <source>the words of this cycle differ between CAM systems</source>
        <translation>此循环的词在各 CAM 系统中含义不同</translation>
    </message>
    <message>
        <source>name the CAM system with --cl-dialect, or let the CAM system write single moves</source>
        <translation>用 --cl-dialect 指明 CAM 系统，或让 CAM 系统写出逐个移动</translation>
    </message>
    <message>
        <source>the numbers of the cycle have no words, and their meaning is unknown</source>
        <translation>循环的数值没有词，含义未知</translation>
    </message>
    <message>
        <source>give the meaning with --cycle-values, such as depth,feed,clearance</source>
        <translation>用 --cycle-values 给出含义，例如 depth,feed,clearance</translation>
    </message>
    <message>
        <source>the tool axis turns by more than 60 degrees on the way to a hole</source>
        <translation>到孔的途中刀轴转动超过 60 度</translation>
    </message>
    <message>
        <source>let the CAM system write the moves between</source>
        <translation>让 CAM 系统写出其间的移动</translation>
    </message>
    <message>
        <source>a motion begins or ends at a hole of a cycle, where the tool is not</source>
        <translation>运动的起点或终点在循环的孔处，而刀具不在那里</translation>
    </message>
    <message>
        <source>write CYCLE/OFF and a GOTO before it</source>
        <translation>在其之前写 CYCLE/OFF 和一个 GOTO</translation>
    </message>
    <message>
        <source>CUTCOM has two readings: its points may be the contour of the part or the centre of the tool</source>
        <translation>CUTCOM 有两种读法：其各点可能是零件轮廓，也可能是刀具中心</translation>
    </message>
    <message>
        <source>give --contour-data contour or --contour-data centre, or set ContourData of the program object</source>
        <translation>给出 --contour-data contour 或 --contour-data centre，或设置程序对象的 ContourData</translation>
    </message>
    <message>
        <source>the points under CUTCOM were taken for the centre of the tool, by their arcs</source>
        <translation>根据其中的圆弧，CUTCOM 下的点被视为刀具中心</translation>
    </message>
    <message>
        <source>check the size of the part, and give --contour-data centre or contour</source>
        <translation>检查零件的大小，并给出 --contour-data centre 或 contour</translation>
    </message>
    <message>
        <source>the unit of length is unknown</source>
        <translation>长度单位未知</translation>
    </message>
    <message>
        <source>give --unit mm or --unit inch, or set Unit of the program object</source>
        <translation>给出 --unit mm 或 --unit inch，或设置程序对象的 Unit</translation>
    </message>
    <message>
        <source>the wear of a tool has no effect</source>
        <translation>刀具的磨损量没有作用</translation>
    </message>
    <message>
        <source>give --wear for a tool that the CL data compensates by CUTCOM</source>
        <translation>对 CL 数据用 CUTCOM 补偿的刀具给出 --wear</translation>
    </message>
    <message>
        <source>nothing in the file shows whether arcs are right-handed or left-handed about their axis</source>
        <translation>文件中没有任何内容表明圆弧绕其轴线是右旋还是左旋</translation>
    </message>
    <message>
        <source>name the CAM system with --cl-dialect; with creo they are right-handed, with nx left-handed</source>
        <translation>用 --cl-dialect 指明 CAM 系统；creo 为右旋，nx 为左旋</translation>
    </message>
    <message>
        <source>the file has no end: it may be truncated</source>
        <translation>文件没有结束：可能不完整</translation>
    </message>
    <message>
        <source>get the complete file; if it is complete, add FINI at its end, give --allow-open-end, or set OpenEnd of the program object</source>
        <translation>取得完整的文件；如果已经完整，在末尾加上 FINI，给出 --allow-open-end，或设置程序对象的 OpenEnd</translation>
    </message>
    <message>
        <source>an option does not apply to this input</source>
        <translation>该选项不适用于此输入</translation>
    </message>
    <message>
        <source>leave it out</source>
        <translation>去掉它</translation>
    </message>
    <message>
        <source>the file gives a tool several gauge lengths; none of them is used</source>
        <translation>文件给出了同一刀具的多个长度；均未使用</translation>
    </message>
    <message>
        <source>give its length with --tool-length</source>
        <translation>用 --tool-length 给出其长度</translation>
    </message>
    <message>
        <source>the home position of the machine is unknown</source>
        <translation>机床的原位未知</translation>
    </message>
    <message>
        <source>give it with --machine-zero X,Y,Z, or set MachineZero of the program object</source>
        <translation>用 --machine-zero X,Y,Z 给出，或设置程序对象的 MachineZero</translation>
    </message>
    <message>
        <source>the strokes of this kind of cycle are not known</source>
        <translation>此类循环的动作未知</translation>
    </message>
    <message>
        <source>give them with --cycle-kinds, such as BORE=ream, or let the CAM system write single moves</source>
        <translation>用 --cycle-kinds 给出，例如 BORE=ream，或让 CAM 系统写出逐个移动</translation>
    </message>
    <message>
        <source>the curve cannot be followed</source>
        <translation>曲线不能跟随</translation>
    </message>
    <message>
        <source>the tool table is not valid</source>
        <translation>刀具表无效</translation>
    </message>
    <message>
        <source>write it as docs/g-code.md describes it: LinuxCNC&apos;s .tbl or .csv with the unit, as in --tool-table tools.tbl,mm, or FreeCAD&apos;s .fctl or .json</source>
        <translation>按 docs/g-code.md 所述书写：LinuxCNC 的 .tbl 或带单位的 .csv，例如 --tool-table tools.tbl,mm，或 FreeCAD 的 .fctl 或 .json</translation>
    </message>
    <message>
        <source>check it; times of CL data are in s, and with REV in turns of the spindle</source>
        <translation>请检查；CL 数据中的时间以秒为单位，带 REV 时以主轴转数为单位</translation>
    </message>
    <message>
        <source>a cut comes before the first tool change</source>
        <translation>切削移动出现在第一次换刀之前</translation>
    </message>
    <message>
        <source>write LOADTL before it</source>
        <translation>请在其之前写出 LOADTL</translation>
    </message>
    <message>
        <source>LENGTH beside IN may be the length outside the holder, and is not used</source>
        <translation>IN 旁的 LENGTH 可能是刀具伸出刀柄的长度，未被采用</translation>
    </message>
    <message>
        <source>give the gauge length with --tool-length</source>
        <translation>用 --tool-length 给出刀具长度（主轴端面到刀尖）</translation>
    </message>
    <message>
        <source>the machine file cannot be read</source>
        <translation>机床文件不能读取</translation>
    </message>
    <message>
        <source>check the path; python3 -m pkm_post machine list shows presets</source>
        <translation>检查路径；python3 -m pkm_post machine list 列出自带的机床</translation>
    </message>
    <message>
        <source>the machine file is not valid TOML</source>
        <translation>机床文件不是有效的 TOML</translation>
    </message>
    <message>
        <source>correct it at the place shown</source>
        <translation>在所示位置改正</translation>
    </message>
    <message>
        <source>an entry is missing</source>
        <translation>缺少一个条目</translation>
    </message>
    <message>
        <source>add it; docs/machine-file.md describes every entry</source>
        <translation>补上它；docs/machine-file.md 说明了每个条目</translation>
    </message>
    <message>
        <source>an entry has the wrong form</source>
        <translation>一个条目的格式错误</translation>
    </message>
    <message>
        <source>correct it; docs/machine-file.md describes every entry</source>
        <translation>改正它；docs/machine-file.md 说明了每个条目</translation>
    </message>
    <message>
        <source>an entry is not known</source>
        <translation>一个条目未知</translation>
    </message>
    <message>
        <source>remove it or correct its spelling</source>
        <translation>删除它，或改正其拼写</translation>
    </message>
    <message>
        <source>entries contradict each other</source>
        <translation>各条目相互矛盾</translation>
    </message>
    <message>
        <source>correct the one shown, or what it is compared with</source>
        <translation>改正所示的条目，或与之相比较的条目</translation>
    </message>
    <message>
        <source>an entry of this machine is unknown</source>
        <translation>此机床的一个条目未知</translation>
    </message>
    <message>
        <source>measure it or ask the maker, and write it in place of &quot;unknown&quot;</source>
        <translation>测量它或询问制造商，并将其写在 &quot;unknown&quot; 处</translation>
    </message>
    <message>
        <source>the machine cannot reach its home pose</source>
        <translation>机床不能到达其零位位姿</translation>
    </message>
    <message>
        <source>correct tool_path.home_tip, or the limit that is in the way</source>
        <translation>改正 tool_path.home_tip，或改正妨碍它的极限</translation>
    </message>
    <message>
        <source>the machine cannot reach the tool-change pose</source>
        <translation>机床不能到达换刀位姿</translation>
    </message>
    <message>
        <source>correct tool_change.nose, or the limit that is in the way</source>
        <translation>改正 tool_change.nose，或改正妨碍它的极限</translation>
    </message>
    <message>
        <source>the measurements cannot be read</source>
        <translation>测量数据不能读取</translation>
    </message>
    <message>
        <source>check the path; docs/machine-file.md describes the file</source>
        <translation>检查路径；docs/machine-file.md 说明了该文件</translation>
    </message>
    <message>
        <source>a row of the measurements is malformed</source>
        <translation>测量数据有一行的格式错误</translation>
    </message>
    <message>
        <source>correct it; docs/machine-file.md describes the file</source>
        <translation>改正它；docs/machine-file.md 说明了该文件</translation>
    </message>
    <message>
        <source>no machine fits the measurements</source>
        <translation>没有机床与测量数据相符</translation>
    </message>
    <message>
        <source>look for wrong rows, units and frames in the measurements</source>
        <translation>检查测量数据中是否有错误的行、单位或坐标系</translation>
    </message>
    <message>
        <source>the calibrated machine cannot be written</source>
        <translation>标定后的机床不能写出</translation>
    </message>
    <message>
        <source>correct the faults reported for the written file</source>
        <translation>改正针对所写文件报告的错误</translation>
    </message>
    <message>
        <source>the poses do not determine all parameters</source>
        <translation>这些位姿不能确定全部参数</translation>
    </message>
    <message>
        <source>measure at more poses, with more tilt and spin</source>
        <translation>在更多位姿处测量，倾角和自转角更大</translation>
    </message>
    <message>
        <source>the machine file is too large</source>
        <translation>机床文件太大</translation>
    </message>
    <message>
        <source>remove what docs/machine-file.md does not describe</source>
        <translation>删除 docs/machine-file.md 未说明的内容</translation>
    </message>
    <message>
        <source>the machine file is nested too deeply</source>
        <translation>机床文件嵌套过深</translation>
    </message>
    <message>
        <source>write tables and lists as docs/machine-file.md has them</source>
        <translation>按 docs/machine-file.md 的形式书写表和列表</translation>
    </message>
    <message>
        <source>a contact point, normal or tool axis is not a number or has no direction</source>
        <translation>接触点、法线或刀轴不是数，或没有方向</translation>
    </message>
    <message>
        <source>regenerate the path</source>
        <translation>重新生成轨迹</translation>
    </message>
    <message>
        <source>the surface is undercut: the corner of the cutter does not touch it</source>
        <translation>曲面内凹：刀具的圆角接触不到</translation>
    </message>
    <message>
        <source>lean the tool further back</source>
        <translation>增大刀具后倾</translation>
    </message>
    <message>
        <source>the normal is parallel to the tool axis and no direction of travel is known</source>
        <translation>法线平行于刀轴，且没有已知的走刀方向</translation>
    </message>
    <message>
        <source>lean the tool</source>
        <translation>使刀具倾斜</translation>
    </message>
    <message>
        <source>the surface is flatter than the bottom of the cutter: its corner does not touch it</source>
        <translation>曲面比刀具底面更平：刀具的圆角接触不到</translation>
    </message>
    <message>
        <source>lean the tool, or take a cutter with a flatter bottom</source>
        <translation>使刀具倾斜，或使用底面更平的刀具</translation>
    </message>
    <message>
        <source>normal and tool axis are nearly parallel, and the side on which the cutter lies depends on rounding</source>
        <translation>法线与刀轴几乎平行，刀具所在的一侧取决于舍入</translation>
    </message>
    <message>
        <source>lean the tool, or give normals with more decimals</source>
        <translation>使刀具倾斜，或给出小数位更多的法线</translation>
    </message>
    <message>
        <source>the tip jumps sideways where normal and tool axis are nearly parallel</source>
        <translation>在法线与刀轴几乎平行处，刀尖横向跳动</translation>
    </message>
    <message>
        <source>lean the tool there, or take a ball end mill</source>
        <translation>在那里使刀具倾斜，或使用球头铣刀</translation>
    </message>
    <message>
        <source>an arc would not stay an arc in 3D compensation</source>
        <translation>圆弧经三维补偿后不再是圆弧</translation>
    </message>
    <message>
        <source>let the CAM system write straight moves</source>
        <translation>让 CAM 系统写出直线移动</translation>
    </message>
    <message>
        <source>there are no surface normals to compensate with</source>
        <translation>没有可用于补偿的曲面法线</translation>
    </message>
    <message>
        <source>let the CAM system write normals</source>
        <translation>让 CAM 系统写出法线</translation>
    </message>
    <message>
        <source>the cutter the path was made for is not known</source>
        <translation>轨迹所针对的刀具未知</translation>
    </message>
    <message>
        <source>pass --tool NUMBER=D,R with its diameter and corner radius; in a CAM job complete the tool bit</source>
        <translation>用 --tool NUMBER=D,R 给出其直径和圆角半径；在 CAM 作业中补全刀头的数据</translation>
    </message>
    <message>
        <source>a cutting move ends on no face of the model</source>
        <translation>一个切削移动的终点不在模型的任何面上</translation>
    </message>
    <message>
        <source>correct the operation; give the faces it cuts, a LeadLength for leads, or a wider Tolerance</source>
        <translation>改正该操作；给出它所切削的面，用于进退刀的 LeadLength，或更大的 Tolerance</translation>
    </message>
    <message>
        <source>a point is at an edge between faces with different normals</source>
        <translation>一个点位于法线不同的面之间的边上</translation>
    </message>
    <message>
        <source>choose the face that is cut in the property Faces, or keep the path off the edge</source>
        <translation>在属性 Faces 中选择所切削的面，或使轨迹避开该边</translation>
    </message>
    <message>
        <source>the surface normal or the tool axis turns too much from one point to the next</source>
        <translation>从一点到下一点，曲面法线或刀轴转动太大</translation>
    </message>
    <message>
        <source>put the points of the operation closer together, end the cut at the edge, or allow more as ChordTolerance</source>
        <translation>使操作的点更密，在边处结束切削，或用 ChordTolerance 允许更大的偏差</translation>
    </message>
    <message>
        <source>the tool leans in the direction of travel, and there is none at a contact point</source>
        <translation>刀具沿走刀方向倾斜，而一个接触点处没有走刀方向</translation>
    </message>
    <message>
        <source>keep the tool axis of the operation, or let the cut continue from there</source>
        <translation>保持该操作的刀轴，或使切削从那里继续</translation>
    </message>
    <message>
        <source>there is no face to touch</source>
        <translation>没有可接触的面</translation>
    </message>
    <message>
        <source>choose the faces again, or leave Faces empty for all of the model</source>
        <translation>重新选择面，或将 Faces 留空以使用整个模型</translation>
    </message>
    <message>
        <source>compensation does not support the shape of the tool</source>
        <translation>补偿不支持该刀具的形状</translation>
    </message>
    <message>
        <source>use a flat, ball or bull nose end mill</source>
        <translation>使用平底、球头或圆角铣刀</translation>
    </message>
    <message>
        <source>the corner radius of a cutter is not known</source>
        <translation>刀具的圆角半径未知</translation>
    </message>
    <message>
        <source>pass it behind the diameter, 0 for a flat end mill, D/2 for a ball nose: --tool NUMBER=D,R for the cutter the path was made for, --actual-tool NUMBER=D,R for the one in the spindle</source>
        <translation>写在直径之后，平底铣刀为 0，球头铣刀为 D/2：轨迹所针对的刀具用 --tool NUMBER=D,R，主轴中的刀具用 --actual-tool NUMBER=D,R</translation>
    </message>
    <message>
        <source>the program has no such tool</source>
        <translation>程序中没有这把刀具</translation>
    </message>
    <message>
        <source>pass --actual-tool with the number of a tool of the program</source>
        <translation>用 --actual-tool 给出程序中刀具的编号</translation>
    </message>
    <message>
        <source>points of contact are not tool tips</source>
        <translation>接触点不是刀尖位置</translation>
    </message>
    <message>
        <source>post the program, which makes tips of them by the cutter</source>
        <translation>对程序进行后处理，由刀具从接触点得出刀尖位置</translation>
    </message>
    <message>
        <source>cutter compensation begins or ends on an arc</source>
        <translation>刀具半径补偿在圆弧上开始或结束</translation>
    </message>
    <message>
        <source>begin and end it on a straight move</source>
        <translation>在直线移动上开始和结束补偿</translation>
    </message>
    <message>
        <source>the tool is too large for the block</source>
        <translation>刀具对该程序段来说太大</translation>
    </message>
    <message>
        <source>use a smaller tool, or let such blocks be removed</source>
        <translation>使用更小的刀具，或允许删去这样的程序段</translation>
    </message>
    <message>
        <source>the tool is too large for the block, which is left out</source>
        <translation>刀具对该程序段来说太大，该程序段已略去</translation>
    </message>
    <message>
        <source>check what is not cut there</source>
        <translation>检查那里未切除的部分</translation>
    </message>
    <message>
        <source>the tool would cut into the contour</source>
        <translation>刀具会切入轮廓</translation>
    </message>
    <message>
        <source>use a smaller tool, or change the contour there</source>
        <translation>使用更小的刀具，或更改那里的轮廓</translation>
    </message>
    <message>
        <source>the tool cuts into the contour where compensation begins, ends or changes its side</source>
        <translation>在补偿开始、结束或换侧之处，刀具切入轮廓</translation>
    </message>
    <message>
        <source>begin and end it farther from the contour, at right angles to it</source>
        <translation>在离轮廓较远处、与轮廓成直角开始和结束补偿</translation>
    </message>
    <message>
        <source>the plane of cutter compensation is not unique here</source>
        <translation>此处刀具半径补偿的平面不唯一</translation>
    </message>
    <message>
        <source>keep plane and tool axis, and arcs in the plane</source>
        <translation>保持平面和刀轴不变，圆弧位于该平面内</translation>
    </message>
    <message>
        <source>only closed lines along u or v can be joined to a spiral</source>
        <translation>只有沿 u 或 v 的封闭线能连成螺旋</translation>
    </message>
    <message>
        <source>choose Zigzag or One way</source>
        <translation>选择“往复”或“单向”</translation>
    </message>
    <message>
        <source>the faces have no area to cover</source>
        <translation>这些面没有可覆盖的面积</translation>
    </message>
    <message>
        <source>choose faces that have an area</source>
        <translation>选择有面积的面</translation>
    </message>
    <message>
        <source>the cutter does not fit into a hollow of the surface, so there is no stepover for a scallop height</source>
        <translation>刀具放不进曲面的凹处，因此没有与残留高度相应的行距</translation>
    </message>
    <message>
        <source>take a smaller cutter, or give the stepover as a distance</source>
        <translation>使用更小的刀具，或以距离给出行距</translation>
    </message>
    <message>
        <source>the tool is tilted too far to be lifted along its axis</source>
        <translation>刀具倾斜太大，不能沿其轴线抬起</translation>
    </message>
    <message>
        <source>lower ConeLimit, the field Cone limit of the operation, or lower Lead and Tilt</source>
        <translation>减小 ConeLimit（操作的“锥角极限”），或减小 Lead 和 Tilt</translation>
    </message>
    <message>
        <source>the tolerances cannot be kept by straight moves</source>
        <translation>用直线移动不能保持公差</translation>
    </message>
    <message>
        <source>raise the tolerances, or lean the tool less</source>
        <translation>放宽公差，或减小刀具倾斜</translation>
    </message>
    <message>
        <source>the surface has an edge, where the tool axis jumps</source>
        <translation>曲面有一条边，刀轴在此处跳变</translation>
    </message>
    <message>
        <source>cover the faces at the edge one by one</source>
        <translation>逐个覆盖该边处的面</translation>
    </message>
    <message>
        <source>the path lies above the height at which the tool traverses</source>
        <translation>轨迹高于刀具横移的高度</translation>
    </message>
    <message>
        <source>raise SafeHeight and ClearanceHeight</source>
        <translation>提高 SafeHeight 和 ClearanceHeight</translation>
    </message>
    <message>
        <source>no face is chosen</source>
        <translation>没有选择面</translation>
    </message>
    <message>
        <source>add faces as base geometry</source>
        <translation>添加面作为基准几何</translation>
    </message>
    <message>
        <source>a value is not valid</source>
        <translation>一个值无效</translation>
    </message>
    <message>
        <source>correct the property</source>
        <translation>改正该属性</translation>
    </message>
    <message>
        <source>the machine cannot reach the part with the tool upright</source>
        <translation>刀具竖直时机床够不到零件</translation>
    </message>
    <message>
        <source>move the part, or take another tool</source>
        <translation>移动零件，或使用其他刀具</translation>
    </message>
    <message>
        <source>the cutter goes deeper into the model than ChordTolerance</source>
        <translation>刀具切入模型的深度超过 ChordTolerance</translation>
    </message>
    <message>
        <source>lean the tool away from what is beside the face, take a smaller cutter, or choose other faces; CheckSpacing 0 shows the path without the measurement</source>
        <translation>使刀具偏离该面旁边的部分，使用更小的刀具，或选择其他面；CheckSpacing 设为 0 时显示轨迹而不测量</translation>
    </message>
    <message>
        <source>the file is not a trajectory file</source>
        <translation>该文件不是轨迹文件</translation>
    </message>
    <message>
        <source>give a .pkmt file</source>
        <translation>给出 .pkmt 文件</translation>
    </message>
    <message>
        <source>the trajectory file has a version that this program does not know</source>
        <translation>本软件不认识该轨迹文件的版本</translation>
    </message>
    <message>
        <source>use a newer PKM Post</source>
        <translation>使用更新的 PKM Post</translation>
    </message>
    <message>
        <source>the trajectory file is damaged</source>
        <translation>轨迹文件已损坏</translation>
    </message>
    <message>
        <source>make it again from its source</source>
        <translation>由其来源重新生成</translation>
    </message>
    <message>
        <source>the trajectory was made for another machine</source>
        <translation>轨迹是为另一台机床生成的</translation>
    </message>
    <message>
        <source>name that machine, as by --machine, or post again for this one</source>
        <translation>指定那台机床（例如用 --machine），或为此机床重新后处理</translation>
    </message>
    <message>
        <source>the trajectory file does not state the requested tolerances</source>
        <translation>轨迹文件没有给出所要求的公差</translation>
    </message>
    <message>
        <source>post the job again</source>
        <translation>重新对作业进行后处理</translation>
    </message>
    <message>
        <source>the trajectory file is inconsistent</source>
        <translation>轨迹文件前后矛盾</translation>
    </message>
    <message>
        <source>the trajectory exceeds the limits of its machine</source>
        <translation>轨迹超出其机床的极限</translation>
    </message>
    <message>
        <source>post the job again for this machine</source>
        <translation>为此机床重新对作业进行后处理</translation>
    </message>
    <message>
        <source>there is no such command or option</source>
        <translation>没有这样的命令或选项</translation>
    </message>
    <message>
        <source>correct it; --help lists them</source>
        <translation>请更正；--help 会列出它们</translation>
    </message>
    <message>
        <source>an argument is missing</source>
        <translation>缺少参数</translation>
    </message>
    <message>
        <source>add it; --help says what it is</source>
        <translation>请补上；--help 有其说明</translation>
    </message>
    <message>
        <source>an argument is not valid</source>
        <translation>参数无效</translation>
    </message>
    <message>
        <source>correct it; --help says what it may be</source>
        <translation>请更正；--help 说明其取值</translation>
    </message>
    <message>
        <source>the tool tip leaves the programmed path</source>
        <translation>刀尖偏离编程路径</translation>
    </message>
    <message>
        <source>request a wider tolerance, or report this as a fault</source>
        <translation>要求更宽的公差，或将其作为软件错误报告</translation>
    </message>
    <message>
        <source>the tool axis leaves the programmed axis</source>
        <translation>刀轴偏离编程刀轴</translation>
    </message>
    <message>
        <source>a strut is faster than the machine allows</source>
        <translation>一条支链的速度超过机床允许值</translation>
    </message>
    <message>
        <source>report this as a fault of the feed planner</source>
        <translation>作为进给规划的错误报告</translation>
    </message>
    <message>
        <source>a strut accelerates more than the machine allows</source>
        <translation>一条支链的加速度超过机床允许值</translation>
    </message>
    <message>
        <source>the program does not start or end at rest</source>
        <translation>程序不是从静止开始或不在静止处结束</translation>
    </message>
    <message>
        <source>a strut leaves its stroke</source>
        <translation>一条支链超出其行程</translation>
    </message>
    <message>
        <source>no pose of the platform belongs to the strut lengths</source>
        <translation>杆长没有对应的动平台位姿</translation>
    </message>
    <message>
        <source>post the job again; do not edit it</source>
        <translation>重新对作业进行后处理；不要编辑它</translation>
    </message>
    <message>
        <source>the feed is exceeded</source>
        <translation>进给超过编程值</translation>
    </message>
    <message>
        <source>the program does not execute the events of the job</source>
        <translation>程序没有执行作业的事件</translation>
    </message>
    <message>
        <source>the program does not follow the whole path</source>
        <translation>程序没有走完整条路径</translation>
    </message>
    <message>
        <source>the struts deviate from their plan</source>
        <translation>支链偏离其规划</translation>
    </message>
    <message>
        <source>the acceleration of a strut changes too fast</source>
        <translation>一条支链的加速度变化太快</translation>
    </message>
    <message>
        <source>the tool axis turns faster than the machine allows</source>
        <translation>刀轴转动速度超过机床允许值</translation>
    </message>
    <message>
        <source>the tip accelerates more than the machine allows</source>
        <translation>刀尖的加速度超过机床允许值</translation>
    </message>
    <message>
        <source>the acceleration of the tip changes too fast</source>
        <translation>刀尖的加速度变化太快</translation>
    </message>
    <message>
        <source>points are too close together for the controller</source>
        <translation>各点的间隔对控制器来说太短</translation>
    </message>
    <message>
        <source>the point rate is too high for the controller</source>
        <translation>点的频率对控制器来说太高</translation>
    </message>
    <message>
        <source>lower the feed, request a wider tolerance, or correct controller.block_rate of the machine file</source>
        <translation>降低进给，要求更宽的公差，或改正机床文件的 controller.block_rate</translation>
    </message>
    <message>
        <source>the program has too few decimals</source>
        <translation>程序的小数位太少</translation>
    </message>
    <message>
        <source>state more in controller.length_decimals and controller.speed_decimals, and controller.line_limit for longer lines if the controller accepts them</source>
        <translation>增大 controller.length_decimals 和 controller.speed_decimals；如果控制器接受更长的行，增大 controller.line_limit</translation>
    </message>
    <message>
        <source>the path needs points closer together than the controller accepts</source>
        <translation>路径所需的点比控制器允许的更密</translation>
    </message>
    <message>
        <source>request a wider tolerance, lower the feed, or correct controller.shortest_interval of the machine file</source>
        <translation>要求更宽的公差，降低进给，或改正机床文件的 controller.shortest_interval</translation>
    </message>
    <message>
        <source>the depth of a thread does not match the turns of the spindle</source>
        <translation>螺纹的深度偏离主轴转数对应的深度</translation>
    </message>
    <message>
        <source>post the job again; do not edit the program. If it was just posted, state more controller.length_decimals, or a wider spindle.axis.lead_tolerance</source>
        <translation>重新后处理该作业;不要编辑程序。如果刚刚后处理过,增大 controller.length_decimals,或放宽 spindle.axis.lead_tolerance</translation>
    </message>
    <message>
        <source>the spindle turns faster in a thread than the machine allows</source>
        <translation>主轴在螺纹中的转速超过机床允许值</translation>
    </message>
    <message>
        <source>the spindle accelerates more in a thread than the machine allows</source>
        <translation>主轴在螺纹中的加速度超过机床允许值</translation>
    </message>
    <message>
        <source>the spindle still turns at the end of the program</source>
        <translation>程序结束时主轴仍在转动</translation>
    </message>
    <message>
        <source>let the program stop it, by M5, M2 or SPINDL/OFF</source>
        <translation>用 M5、M2 或 SPINDL/OFF 使程序停止主轴</translation>
    </message>
    <message>
        <source>the program ends with the tool low</source>
        <translation>程序结束时刀具位置较低</translation>
    </message>
    <message>
        <source>check that the program is complete, and retract the tool at its end if it has to be clear</source>
        <translation>确认程序完整；如果刀具须离开工件，在程序末尾退刀</translation>
    </message>
    <message>
        <source>tool path</source>
        <translation>刀具路径</translation>
    </message>
    <message>
        <source>machine limits</source>
        <translation>机床极限</translation>
    </message>
    <message>
        <source>collisions</source>
        <translation>碰撞</translation>
    </message>
    <message>
        <source>approach, tool change, spindle</source>
        <translation>接近、换刀、主轴</translation>
    </message>
    <message>
        <source>machine and set-up</source>
        <translation>机床与设置</translation>
    </message>
    <message>
        <source>proven</source>
        <translation>已证明</translation>
    </message>
    <message>
        <source>sampled</source>
        <translation>抽样</translation>
    </message>
    <message>
        <source>not covered</source>
        <translation>未涵盖</translation>
    </message>
    <message>
        <source>there is no connection</source>
        <translation>没有连接</translation>
    </message>
    <message>
        <source>the controller does not answer</source>
        <translation>控制器没有应答</translation>
    </message>
    <message>
        <source>another command is being executed</source>
        <translation>正在执行另一指令</translation>
    </message>
    <message>
        <source>no program was opened</source>
        <translation>未打开程序</translation>
    </message>
    <message>
        <source>the program is not loaded</source>
        <translation>程序尚未下载</translation>
    </message>
    <message>
        <source>no trajectory was opened</source>
        <translation>没有打开轨迹</translation>
    </message>
    <message>
        <source>a trajectory is played</source>
        <translation>正在播放轨迹</translation>
    </message>
    <message>
        <source>no trajectory is played</source>
        <translation>没有播放轨迹</translation>
    </message>
    <message>
        <source>the play is not waiting</source>
        <translation>播放没有在等待</translation>
    </message>
    <message>
        <source>no block comes next</source>
        <translation>没有下一程序段</translation>
    </message>
    <message>
        <source>the program has no stop with moves after it</source>
        <translation>程序中没有其后仍有运动的停止点</translation>
    </message>
    <message>
        <source>a program runs</source>
        <translation>程序正在运行</translation>
    </message>
    <message>
        <source>a program is held</source>
        <translation>程序处于进给保持</translation>
    </message>
    <message>
        <source>no program is held</source>
        <translation>没有处于进给保持的程序</translation>
    </message>
    <message>
        <source>the machine moves</source>
        <translation>机床正在运动</translation>
    </message>
    <message>
        <source>not all struts are homed</source>
        <translation>并非所有支链都已回零</translation>
    </message>
    <message>
        <source>the struts look for their homes</source>
        <translation>支链正在回零</translation>
    </message>
    <message>
        <source>all struts have found their homes</source>
        <translation>所有支链均已回零</translation>
    </message>
    <message>
        <source>the controller shows no homing</source>
        <translation>控制器未显示回零动作</translation>
    </message>
    <message>
        <source>the homing has failed</source>
        <translation>回零失败</translation>
    </message>
    <message>
        <source>the homing takes too long</source>
        <translation>回零用时过长</translation>
    </message>
    <message>
        <source>on its lower limit</source>
        <translation>到达下极限</translation>
    </message>
    <message>
        <source>on its upper limit</source>
        <translation>到达上极限</translation>
    </message>
    <message>
        <source>stopped on a limit</source>
        <translation>因极限而停止</translation>
    </message>
    <message>
        <source>in open loop</source>
        <translation>处于开环</translation>
    </message>
    <message>
        <source>searching its home</source>
        <translation>正在回零</translation>
    </message>
    <message>
        <source>follows a master position (Ixx06)</source>
        <translation>跟随主位置（Ixx06）</translation>
    </message>
    <message>
        <source>amplifier fault</source>
        <translation>驱动器故障</translation>
    </message>
    <message>
        <source>following error too large, switched off</source>
        <translation>跟随误差过大，已关断</translation>
    </message>
    <message>
        <source>following error at its warning limit</source>
        <translation>跟随误差达到警告极限</translation>
    </message>
    <message>
        <source>on its lower soft limit</source>
        <translation>到达软件下极限</translation>
    </message>
    <message>
        <source>on its upper soft limit</source>
        <translation>到达软件上极限</translation>
    </message>
    <message>
        <source>the program ended with an error</source>
        <translation>程序因错误而结束</translation>
    </message>
    <message>
        <source>an amplifier has a fault</source>
        <translation>有驱动器故障</translation>
    </message>
    <message>
        <source>a following error was too large</source>
        <translation>有跟随误差过大</translation>
    </message>
    <message>
        <source>a limit was met</source>
        <translation>碰到极限</translation>
    </message>
    <message>
        <source>a lower limit was met</source>
        <translation>碰到下极限</translation>
    </message>
    <message>
        <source>an upper limit was met</source>
        <translation>碰到上极限</translation>
    </message>
    <message>
        <source>THE LINK TO THE CONTROLLER IS LOST AND THE MACHINE MAY BE MOVING. This computer cannot stop it now.</source>
        <translation>与控制器的连接已丢失，机床可能正在运动。本计算机现在无法使其停止。</translation>
    </message>
    <message>
        <source>1. If anything looks wrong, press the EMERGENCY STOP of the machine. Do not wait for this computer.</source>
        <translation>1. 如有任何异常，立即按下机床的急停按钮。不要等待本计算机。</translation>
    </message>
    <message>
        <source>2. Keep everybody away from the machine. The program continues in the controller until it ends.</source>
        <translation>2. 让所有人远离机床。程序会在控制器中继续运行直至结束。</translation>
    </message>
    <message>
        <source>3. If the machine has a feed hold of its own, press it, and make sure that all six struts are at rest.</source>
        <translation>3. 如果机床自带进给保持按钮，请按下，并确认六条支链全部静止。</translation>
    </message>
    <message>
        <source>4. Then check the cable, the power of the controller, and this computer; leave the machine as it is.</source>
        <translation>4. 然后检查电缆、控制器电源和本计算机；保持机床原状。</translation>
    </message>
    <message>
        <source>5. When the controller answers again: status, then hold, then abort; only then start, resume, jog or load.</source>
        <translation>5. 控制器恢复应答后：先查看状态，然后进给保持，再中止。在此之前不要启动、恢复、点动或下载。</translation>
    </message>
    <message>
        <source>6. If the power was off or the emergency stop was pressed: home the machine before anything else.</source>
        <translation>6. 如果曾断电或按过急停：首先使机床回零，然后再进行其他操作。</translation>
    </message>
    <message>
        <source>THE MACHINE IS NOT SEEN AT REST. This computer keeps trying to stop it; do not wait for that.</source>
        <translation>未见机床静止。本计算机将继续尝试使其停止；请勿等待。</translation>
    </message>
    <message>
        <source>interval without a pose</source>
        <translation>没有位姿的区间</translation>
    </message>
    <message>
        <source>deviation of the tool tip</source>
        <translation>刀尖偏差</translation>
    </message>
    <message>
        <source>deviation of the tool axis</source>
        <translation>刀轴偏差</translation>
    </message>
    <message>
        <source>tool tip off a programmed point</source>
        <translation>刀尖偏离编程点</translation>
    </message>
    <message>
        <source>tool axis off a programmed one</source>
        <translation>刀轴偏离编程刀轴</translation>
    </message>
    <message>
        <source>strut off its plan</source>
        <translation>支链偏离规划</translation>
    </message>
    <message>
        <source>tip speed</source>
        <translation>刀尖速度</translation>
    </message>
    <message>
        <source>strut speed</source>
        <translation>支链速度</translation>
    </message>
    <message>
        <source>strut acceleration</source>
        <translation>支链加速度</translation>
    </message>
    <message>
        <source>turning rate of the tool axis</source>
        <translation>刀轴转动速度</translation>
    </message>
    <message>
        <source>tip acceleration</source>
        <translation>刀尖加速度</translation>
    </message>
    <message>
        <source>shortest strut</source>
        <translation>最短杆长</translation>
    </message>
    <message>
        <source>longest strut</source>
        <translation>最长杆长</translation>
    </message>
    <message>
        <source>shortest interval</source>
        <translation>最短区间</translation>
    </message>
    <message>
        <source>depth of a thread off its turns</source>
        <translation>螺纹深度相对转数的偏差</translation>
    </message>
    <message>
        <source>spindle speed in a thread</source>
        <translation>螺纹中的主轴转速</translation>
    </message>
    <message>
        <source>spindle acceleration in a thread</source>
        <translation>螺纹中的主轴加速度</translation>
    </message>
    <message>
        <source>add or activate an operation, or mend one that CAM computed without a move, and recompute</source>
        <translation>添加或启用一个操作，或修正一个 CAM 计算后没有运动的操作，然后重新计算</translation>
    </message>
    <message>
        <source>7. Move the tool clear of the part by short jogs along its axis, then to the start, before a program runs again.</source>
        <translation>7. 再次运行程序之前，先沿刀轴以小步点动使刀具离开工件，然后移至起点。</translation>
    </message>
    <message>
        <source>step of strut acceleration at a knot</source>
        <translation>节点处支链加速度的突变</translation>
    </message>
    <message>
        <source>blocks in one second</source>
        <translation>一秒内的程序段数</translation>
    </message>
    <message>
        <source>strut jerk</source>
        <translation>支链加加速度</translation>
    </message>
    <message>
        <source>tip jerk</source>
        <translation>刀尖加加速度</translation>
    </message>
    <message>
        <source>tip moved by one count of each strut</source>
        <translation>各支链一个计数引起的刀尖位移</translation>
    </message>
    <message>
        <source>contour error by following errors</source>
        <translation>跟随误差引起的轮廓误差</translation>
    </message>
    <message>
        <source>tool tip and axis</source>
        <translation>刀尖和刀轴</translation>
    </message>
    <message>
        <source>feed</source>
        <translation>进给</translation>
    </message>
    <message>
        <source>events</source>
        <translation>事件</translation>
    </message>
    <message>
        <source>strut length, speed and acceleration</source>
        <translation>杆长、支链速度和加速度</translation>
    </message>
    <message>
        <source>tip acceleration and turning rate of the tool axis</source>
        <translation>刀尖加速度和刀轴转动速度</translation>
    </message>
    <message>
        <source>intervals between points</source>
        <translation>各点的时间间隔</translation>
    </message>
    <message>
        <source>joints and singular poses</source>
        <translation>铰链和奇异位姿</translation>
    </message>
    <message>
        <source>geometry of the machine</source>
        <translation>机床几何</translation>
    </message>
    <message>
        <source>work offset and gauge lengths</source>
        <translation>工件偏置和刀具长度</translation>
    </message>
    <message>
        <source>controller set-up, codes and override</source>
        <translation>控制器设置、代码和倍率</translation>
    </message>
    <message>
        <source>stiffness, heat and cutting forces</source>
        <translation>刚度、热和切削力</translation>
    </message>
    <message>
        <source>blocks in a second</source>
        <translation>每秒程序段数</translation>
    </message>
    <message>
        <source>following error</source>
        <translation>跟随误差</translation>
    </message>
    <message>
        <source>way to the start of the program</source>
        <translation>到程序起点的路径</translation>
    </message>
    <message>
        <source>approach from the start to the first point</source>
        <translation>从起点到第一个点的接近</translation>
    </message>
    <message>
        <source>tool change</source>
        <translation>换刀</translation>
    </message>
    <message>
        <source>spindle speed at the first cut</source>
        <translation>第一次切削时的主轴转速</translation>
    </message>
    <message>
        <source>steps of acceleration at knots</source>
        <translation>节点处加速度的突变</translation>
    </message>
    <message>
        <source>strut and strut</source>
        <translation>支链与支链</translation>
    </message>
    <message>
        <source>strut and platform</source>
        <translation>支链与动平台</translation>
    </message>
    <message>
        <source>strut and fixture</source>
        <translation>支链与夹具</translation>
    </message>
    <message>
        <source>spindle and fixture</source>
        <translation>主轴与夹具</translation>
    </message>
    <message>
        <source>no computer of this name is known</source>
        <translation>没有以此命名的计算机</translation>
    </message>
    <message>
        <source>{peer}, port {port}: {reason}</source>
        <translation>{peer}，端口 {port}：{reason}</translation>
    </message>
    <message>
        <source>the connection is refused</source>
        <translation>连接被拒绝</translation>
    </message>
    <message>
        <source>{peer}: {reason}</source>
        <translation>{peer}：{reason}</translation>
    </message>
    <message>
        <source>there is no answer</source>
        <translation>没有应答</translation>
    </message>
    <message>
        <source>there is no such port</source>
        <translation>没有这个端口</translation>
    </message>
    <message>
        <source>port: expected {}, got {!r}</source>
        <translation>端口：应为 {}，实为 {!r}</translation>
    </message>
    <message>
        <source>port: expected 1 to 65535, got {}</source>
        <translation>端口：应为 1 到 65535，实为 {}</translation>
    </message>
    <message>
        <source>no answer for {}</source>
        <translation>{} 内没有应答</translation>
    </message>
    <message>
        <source>what is in the way is reported before</source>
        <translation>原因见前面的信息</translation>
    </message>
    <message>
        <source>a homing starts with one of {}, not with {!r}</source>
        <translation>回零的启动行应为以下之一：{}，而不是 {!r}</translation>
    </message>
    <message>
        <source>the jog leads to where the tool is</source>
        <translation>点动的终点就是刀具所在的位置</translation>
    </message>
    <message>
        <source>strut {} by {}</source>
        <translation>支链 {}，移动 {}</translation>
    </message>
    <message>
        <source>the link is back</source>
        <translation>连接已恢复</translation>
    </message>
    <message>
        <source>the link is lost; the machine comes to rest on the path: {}</source>
        <translation>连接已丢失；机床在路径上停下：{}</translation>
    </message>
    <message>
        <source>no pose of the platform reachable in small steps from home has these strut lengths</source>
        <translation>从回零位姿以小步可到达的平台位姿中，没有一个具有这些支链长度</translation>
    </message>
    <message>
        <source>the tool is {} above its path; it returns before the play continues</source>
        <translation>刀具在其路径上方 {}；继续播放之前先返回</translation>
    </message>
    <message>
        <source>no retract: {}</source>
        <translation>没有退刀：{}</translation>
    </message>
    <message>
        <source>{} points, this the first</source>
        <translation>共 {} 个点，这是第一个</translation>
    </message>
    <message>
        <source>its heights are not those of {}: clear the name, then choose it again</source>
        <translation>其高度不是 {} 中的高度：请清除文件名，再重新选择</translation>
    </message>
    <message>
        <source>HorizFeed of {} is 0</source>
        <translation>{} 的 HorizFeed 为 0</translation>
    </message>
    <message>
        <source>its operations have different tool controllers</source>
        <translation>其各操作的刀具控制器不同</translation>
    </message>
    <message>
        <source>{} has an error</source>
        <translation>{} 有错误</translation>
    </message>
    <message>
        <source>its computation was stopped</source>
        <translation>其计算被停止</translation>
    </message>
    <message>
        <source>behind the last line its path has {}</source>
        <translation>最后一行之后，其路径还有 {}</translation>
    </message>
    <message>
        <source>it has no probed heights</source>
        <translation>它没有测得的高度</translation>
    </message>
    <message>
        <source>its job has no model</source>
        <translation>其作业没有模型</translation>
    </message>
    <message>
        <source>its tool controller has no tool</source>
        <translation>其刀具控制器没有刀具</translation>
    </message>
    <message>
        <source>{} cannot be read</source>
        <translation>无法读取 {}</translation>
    </message>
    <message>
        <source>line {}, {!r}, where its path has {}</source>
        <translation>第 {} 行 {!r}，而其路径中是 {}</translation>
    </message>
    <message>
        <source>nothing</source>
        <translation>无</translation>
    </message>
    <message>
        <source>a recompute is under way</source>
        <translation>正在重新计算</translation>
    </message>
    <message>
        <source>{}{}</source>
        <translation>{}{}</translation>
    </message>
    <message>
        <source>{}, the machine file has {}</source>
        <translation>{}，机床文件有 {}</translation>
    </message>
    <message>
        <source>{} files by {}</source>
        <translation>{} 个文件，按 {} 拆分</translation>
    </message>
    <message>
        <source>nothing to post</source>
        <translation>没有可后处理的内容</translation>
    </message>
    <message>
        <source>{}, until {}</source>
        <translation>{}，到 {} 为止</translation>
    </message>
    <message>
        <source>only rapid moves</source>
        <translation>只有快速运动</translation>
    </message>
    <message>
        <source>none is set</source>
        <translation>未设置</translation>
    </message>
    <message>
        <source>T{}, no tool controller has this number</source>
        <translation>T{}，没有刀具控制器使用此编号</translation>
    </message>
    <message>
        <source>{}: {}</source>
        <translation>{}：{}</translation>
    </message>
    <message>
        <source>{} is {} from {}, Tolerance {}</source>
        <translation>{}：{}，距 {}，公差 {}</translation>
    </message>
    <message>
        <source>{} is on {} and on {}</source>
        <translation>{} 位于 {} 和 {} 上</translation>
    </message>
    <message>
        <source>X {}, Y {}, Z {}</source>
        <translation>X {}、Y {}、Z {}</translation>
    </message>
    <message>
        <source>{}, and {} more like it</source>
        <translation>{}，另有 {} 处类似</translation>
    </message>
    <message>
        <source>{} at X {}, Y {}, Z {}</source>
        <translation>{}，位于 X {}、Y {}、Z {}</translation>
    </message>
    <message>
        <source>FreeCAD reads only files with Unicode names</source>
        <translation>FreeCAD 只能读取 Unicode 文件名的文件</translation>
    </message>
    <message>
        <source>meaning of the part program</source>
        <translation>零件程序的含义</translation>
    </message>
    <message>
        <source>its base operation no longer exists</source>
        <translation>它的基础操作已不存在</translation>
    </message>
    <message>
        <source>number or diameter of its tool is 0</source>
        <translation>其刀具编号或直径为 0</translation>
    </message>
    <message>
        <source>the document does not store why</source>
        <translation>文档中没有保存原因</translation>
    </message>
    <message>
        <source>{}, the job has {}</source>
        <translation>{}，作业有 {}</translation>
    </message>
    <message>
        <source>{}, the job has no tools</source>
        <translation>{}，作业没有刀具</translation>
    </message>
    <message>
        <source>OpenCASCADE cannot read it as STEP</source>
        <translation>OpenCASCADE 无法按 STEP 读取</translation>
    </message>
    <message>
        <source>{} long around X {} Y {} Z {}, now {} around X {} Y {} Z {}</source>
        <translation>长 {}，中心 X {} Y {} Z {}，现在长 {}，中心 X {} Y {} Z {}</translation>
    </message>
    <message>
        <source>no job in the document</source>
        <translation>文档中没有作业</translation>
    </message>
    <message>
        <source>without {}</source>
        <translation>没有 {}</translation>
    </message>
    <message>
        <source>it needs {} beside it</source>
        <translation>旁边需要有 {}</translation>
    </message>
    <message>
        <source>{} of {} moves</source>
        <translation>{}，涉及 {} 个移动</translation>
    </message>
    <message>
        <source>Base is empty</source>
        <translation>Base 为空</translation>
    </message>
    <message>
        <source>a machine limits the tilt from upright: ConeAxis is not (0, 0, 1)</source>
        <translation>机床限制相对竖直方向的倾角：ConeAxis 不是 (0, 0, 1)</translation>
    </message>
    <message>
        <source>{} at {}</source>
        <translation>{}，工件偏置 {}</translation>
    </message>
    <message>
        <source>{!r} of diameter {} and gauge length {}</source>
        <translation>{!r}，直径 {}，刀具长度 {}</translation>
    </message>
    <message>
        <source>SpindleDir {}, CAM&apos;s path of it {}</source>
        <translation>SpindleDir 为 {}，CAM 的轨迹中为 {}</translation>
    </message>
    <message>
        <source>it has no tool</source>
        <translation>它没有刀具</translation>
    </message>
    <message>
        <source>T{} is {} and {}</source>
        <translation>T{} 是 {} 和 {}</translation>
    </message>
    <message>
        <source>{} is of the shape {}</source>
        <translation>{} 的形状是 {}</translation>
    </message>
    <message>
        <source>{}, {} {}, by {}</source>
        <translation>{}，{} {}，差 {}</translation>
    </message>
    <message>
        <source>{} against the {}{}</source>
        <translation>{}对{}{}</translation>
    </message>
    <message>
        <source>machine and rapid moves against the stock</source>
        <translation>机床和快速移动对毛坯</translation>
    </message>
    <message>
        <source>machine and tool against the part</source>
        <translation>机床和刀具对零件</translation>
    </message>
    <message>
        <source>machine and tool against clamps and fixtures</source>
        <translation>机床和刀具对压板和夹具</translation>
    </message>
    <message>
        <source>spindle and holder</source>
        <translation>主轴和刀柄</translation>
    </message>
    <message>
        <source>struts</source>
        <translation>支链</translation>
    </message>
    <message>
        <source>cutters in rapid moves</source>
        <translation>快速移动中的刀具</translation>
    </message>
    <message>
        <source>cutters in cutting moves</source>
        <translation>切削移动中的刀具</translation>
    </message>
    <message>
        <source>shanks</source>
        <translation>刀杆</translation>
    </message>
    <message>
        <source>cutters</source>
        <translation>刀具</translation>
    </message>
    <message>
        <source>strut</source>
        <translation>支链</translation>
    </message>
    <message>
        <source>part</source>
        <translation>零件</translation>
    </message>
    <message>
        <source>stock</source>
        <translation>毛坯</translation>
    </message>
    <message>
        <source>fixture</source>
        <translation>夹具</translation>
    </message>
    <message>
        <source>{} in a rapid move</source>
        <translation>{}（快速移动中）</translation>
    </message>
    <message>
        <source>{} no longer exists</source>
        <translation>{} 已不存在</translation>
    </message>
    <message>
        <source>from Z {} to {}, now from Z {} to {}</source>
        <translation>原为 Z {} 至 {}，现为 Z {} 至 {}</translation>
    </message>
    <message>
        <source>from X {} Y {} to X {} Y {}, now from X {} Y {} to X {} Y {}</source>
        <translation>从 X {} Y {} 到 X {} Y {}，现在从 X {} Y {} 到 X {} Y {}</translation>
    </message>
    <message>
        <source>nothing behind its label</source>
        <translation>其标签之后没有内容</translation>
    </message>
    <message>
        <source>{}, {}</source>
        <translation>{}，{}</translation>
    </message>
    <message>
        <source>holes {}</source>
        <translation>孔 {}</translation>
    </message>
    <message>
        <source>holding tags {} of {}</source>
        <translation>支撑标签 {}（共 {} 个）</translation>
    </message>
    <message>
        <source>{}, where the tool cuts nothing</source>
        <translation>{}，刀具在该处没有切削</translation>
    </message>
    <message>
        <source>{} given, the document has {}</source>
        <translation>给出了 {}，文档中有 {}</translation>
    </message>
    <message>
        <source>no name</source>
        <translation>未给名称</translation>
    </message>
    <message>
        <source>MachineZero: expected X, Y and Z or nothing, got {}</source>
        <translation>MachineZero：应为 X、Y 和 Z 或留空，实际为 {}</translation>
    </message>
    <message>
        <source>{} triangles</source>
        <translation>{} 个三角形</translation>
    </message>
    <message>
        <source>shank of {}</source>
        <translation>{} 的刀杆</translation>
    </message>
    <message>
        <source>{}, stock {}, at X{:.1f} Y{:.1f} Z{:.1f}</source>
        <translation>{}，毛坯 {}，位于 X{:.1f} Y{:.1f} Z{:.1f}</translation>
    </message>
    <message>
        <source>unknown: {}</source>
        <translation>未知：{}</translation>
    </message>
    <message>
        <source>missing: {}</source>
        <translation>缺少：{}</translation>
    </message>
    <message>
        <source>{option}: expected {expected}, got {text!r}</source>
        <translation>{option}：应为 {expected}，实为 {text!r}</translation>
    </message>
    <message>
        <source>a quotation mark is not closed in {text!r}</source>
        <translation>引号没有闭合：{text!r}</translation>
    </message>
    <message>
        <source>{fault} in {text!r}</source>
        <translation>{fault}（位于 {text!r}）</translation>
    </message>
    <message>
        <source>{}, the program has {}</source>
        <translation>{}，程序有 {}</translation>
    </message>
    <message>
        <source>it was written</source>
        <translation>曾经写入</translation>
    </message>
    <message>
        <source>no triangles</source>
        <translation>没有三角形</translation>
    </message>
    <message>
        <source>triangle {} has an implausible coordinate</source>
        <translation>三角形 {} 的坐标不合理</translation>
    </message>
    <message>
        <source>cutter compensation with a tool of unknown diameter</source>
        <translation>刀具直径未知却使用刀具半径补偿</translation>
    </message>
    <message>
        <source>access is denied</source>
        <translation>访问被拒绝</translation>
    </message>
    <message>
        <source>it is a file, not a folder</source>
        <translation>这是文件，不是文件夹</translation>
    </message>
    <message>
        <source>it is a folder, not a file</source>
        <translation>这是文件夹，不是文件</translation>
    </message>
    <message>
        <source>there is no such file or folder</source>
        <translation>没有这个文件或文件夹</translation>
    </message>
    <message>
        <source>the disk is full</source>
        <translation>磁盘已满</translation>
    </message>
    <message>
        <source>there is a file where a folder is named</source>
        <translation>路径中应为文件夹之处是文件</translation>
    </message>
    <message>
        <source>the disk is read-only</source>
        <translation>磁盘为只读</translation>
    </message>
    <message>
        <source>{file}: {reason}</source>
        <translation>{file}：{reason}</translation>
    </message>
    <message>
        <source>its ends would move {} apart</source>
        <translation>其两端会分开 {}</translation>
    </message>
    <message>
        <source>T{}, the program has {}</source>
        <translation>T{}，程序有 {}</translation>
    </message>
    <message>
        <source>no row of the tool has one</source>
        <translation>该刀具的所有行都没有</translation>
    </message>
    <message>
        <source>T{}, of which the diameter alone is given: {}</source>
        <translation>T{}，只给出了直径：{}</translation>
    </message>
    <message>
        <source>{} degrees from upright</source>
        <translation>与竖直方向相差 {} 度</translation>
    </message>
    <message>
        <source>a number</source>
        <translation>数</translation>
    </message>
    <message>
        <source>a number above 0</source>
        <translation>大于 0 的数</translation>
    </message>
    <message>
        <source>a whole number above 0</source>
        <translation>大于 0 的整数</translation>
    </message>
    <message>
        <source>a number from {} to {}</source>
        <translation>{} 到 {} 之间的数</translation>
    </message>
    <message>
        <source>a number above 0 and up to {}</source>
        <translation>大于 0 且不超过 {} 的数</translation>
    </message>
    <message>
        <source>T{}, {} is more than {}</source>
        <translation>T{}，{} 大于 {}</translation>
    </message>
    <message>
        <source>xy, xz, yz or an angle within 360 degrees</source>
        <translation>xy、xz、yz 或 360 度以内的角度</translation>
    </message>
    <message>
        <source>X,Y,Z or X,Y,Z,DEG</source>
        <translation>X,Y,Z 或 X,Y,Z,DEG</translation>
    </message>
    <message>
        <source>one of {}</source>
        <translation>以下之一：{}</translation>
    </message>
    <message>
        <source>one of {} after =</source>
        <translation>= 之后为以下之一：{}</translation>
    </message>
    <message>
        <source>names out of {}</source>
        <translation>以下名称：{}</translation>
    </message>
    <message>
        <source>different names out of {}</source>
        <translation>以下名称，不重复：{}</translation>
    </message>
    <message>
        <source>KIND=STROKES,... with strokes out of {}</source>
        <translation>KIND=STROKES,...，STROKES 为以下之一：{}</translation>
    </message>
    <message>
        <source>x,y,z or px,py,pz and nx,ny,nz, and others of {}, in any order</source>
        <translation>x,y,z 或 px,py,pz 和 nx,ny,nz，以及 {} 中的其他项，顺序任意</translation>
    </message>
    <message>
        <source>G and M codes such as M21,G187</source>
        <translation>G 和 M 代码，如 M21,G187</translation>
    </message>
    <message>
        <source>numbers from 0 to 9 such as 2,3</source>
        <translation>0 到 9 的数字，如 2,3</translation>
    </message>
    <message>
        <source>NAME=X,Y,Z[,DEG] with G54 to G59.3, G54.1P1 to G54.1P300 or G500 to G599</source>
        <translation>NAME=X,Y,Z[,DEG]，NAME 为 G54 到 G59.3、G54.1P1 到 G54.1P300 或 G500 到 G599</translation>
    </message>
    <message>
        <source>N or OPERATION:N, a line from 1 on</source>
        <translation>N 或 OPERATION:N，行号从 1 起</translation>
    </message>
    <message>
        <source>the number of a side, from 1</source>
        <translation>侧面的编号，从 1 起</translation>
    </message>
    <message>
        <source>in {} of the cutting time; with a tip tolerance of {} and an axis tolerance of {} they become curves</source>
        <translation>占切削时间的 {}；刀尖公差为 {}、刀轴公差为 {} 时，它们成为曲线</translation>
    </message>
    <message>
        <source>in {} of the cutting time; with a tip tolerance of {} they become curves</source>
        <translation>占切削时间的 {}；刀尖公差为 {} 时，它们成为曲线</translation>
    </message>
    <message>
        <source>{} has no {}-*-none-any.whl, and there is no pip for other wheels</source>
        <translation>{} 中没有 {}-*-none-any.whl，也没有用于其他 wheel 文件的 pip</translation>
    </message>
    <message>
        <source>{}</source>
        <translation>{}</translation>
    </message>
    <message>
        <source>{} has no pip: install pip, or name a folder with wheels</source>
        <translation>{} 没有 pip：请安装 pip，或指定含 wheel 文件的文件夹</translation>
    </message>
    <message>
        <source>{} has {}, which is no module: install pip for it</source>
        <translation>{} 含有 {}，它不是模块：请为此安装 pip</translation>
    </message>
    <message>
        <source>operations {}</source>
        <translation>操作 {}</translation>
    </message>
    <message>
        <source>the last line that moves is {}</source>
        <translation>最后一个移动的行是 {}</translation>
    </message>
    <message>
        <source>no move at all</source>
        <translation>没有任何移动</translation>
    </message>
    <message>
        <source>T{}: diameter {}, at most {}</source>
        <translation>T{}：直径 {}，最大 {}</translation>
    </message>
    <message>
        <source>T{}: gauge length {}, at most {}</source>
        <translation>T{}：刀具长度 {}，最大 {}</translation>
    </message>
    <message>
        <source>the work offset is a mirror</source>
        <translation>工件偏置是镜像</translation>
    </message>
    <message>
        <source>T{}, at most {}</source>
        <translation>T{}，最多 {}</translation>
    </message>
    <message>
        <source>side {} of {}</source>
        <translation>第 {} 面，共 {} 面</translation>
    </message>
    <message>
        <source>{} aside</source>
        <translation>偏离 {}</translation>
    </message>
    <message>
        <source>the spindle was at {} rpm before</source>
        <translation>之前主轴转速为 {} 转/分</translation>
    </message>
    <message>
        <source>{} degrees above the horizontal, at least {} are needed</source>
        <translation>高于水平面 {} 度，至少需要 {} 度</translation>
    </message>
    <message>
        <source>the tip is at z = {}, the plane at {}</source>
        <translation>刀尖在 z = {}，平面在 {}</translation>
    </message>
    <message>
        <source>radius of the corner {}</source>
        <translation>圆角半径 {}</translation>
    </message>
    <message>
        <source>no pass lies on it</source>
        <translation>没有走刀落在其上</translation>
    </message>
    <message>
        <source>after {} halvings, {} moves are too long</source>
        <translation>经过 {} 次对分后，仍有 {} 个移动过长</translation>
    </message>
    <message>
        <source>its first move is a feed move</source>
        <translation>其第一个移动是进给移动</translation>
    </message>
    <message>
        <source>no lift leads away from the end of this pass</source>
        <translation>这条走刀的末端没有抬刀</translation>
    </message>
    <message>
        <source>the lift from this pass ends below where rapid moves went</source>
        <translation>这条走刀的抬刀终点低于快速移动的高度</translation>
    </message>
    <message>
        <source>the plane is not parallel to two axes any more</source>
        <translation>该平面不再与两个轴平行</translation>
    </message>
    <message>
        <source>lead {}</source>
        <translation>导程 {}</translation>
    </message>
    <message>
        <source>it begins towards the spindle</source>
        <translation>它朝向主轴开始</translation>
    </message>
    <message>
        <source>the file is no text, hence no motion program</source>
        <translation>该文件不是文本，因此不是运动程序</translation>
    </message>
    <message>
        <source>{} moves have one</source>
        <translation>{} 个移动有</translation>
    </message>
    <message>
        <source>{} and {}</source>
        <translation>{} 与 {}</translation>
    </message>
    <message>
        <source>{!r} is not a length above zero, up to {}</source>
        <translation>{!r} 不是大于零且不超过 {} 的长度</translation>
    </message>
    <message>
        <source>no machine of this name comes with PKM Post</source>
        <translation>PKM Post 没有附带此名称的机床</translation>
    </message>
    <message>
        <source>strut {part} by {by}</source>
        <translation>支链 {part}，差 {by}</translation>
    </message>
    <message>
        <source>struts {part} by {by}</source>
        <translation>支链 {part}，差 {by}</translation>
    </message>
    <message>
        <source>{} and part</source>
        <translation>{} 与零件</translation>
    </message>
    <message>
        <source>{part} by {by}</source>
        <translation>{part}，差 {by}</translation>
    </message>
    <message>
        <source>{} and fixture</source>
        <translation>{} 与夹具</translation>
    </message>
    <message>
        <source>strut and part</source>
        <translation>支链与零件</translation>
    </message>
    <message>
        <source>joint {part} by {by}</source>
        <translation>铰链 {part}，超出 {by}</translation>
    </message>
    <message>
        <source>smallest singular value below {least} by {by}</source>
        <translation>最小奇异值低于 {least}，差 {by}</translation>
    </message>
    <message>
        <source>singular poses</source>
        <translation>奇异位姿</translation>
    </message>
    <message>
        <source>strut {part} by {by}; it reaches {limit}</source>
        <translation>支链 {part}，超出 {by}；极限为 {limit}</translation>
    </message>
    <message>
        <source>shortest struts</source>
        <translation>最短杆长</translation>
    </message>
    <message>
        <source>strut {part} by {by}; it shortens to {limit}</source>
        <translation>支链 {part}，短了 {by}；最短可到 {limit}</translation>
    </message>
    <message>
        <source>longest struts</source>
        <translation>最长杆长</translation>
    </message>
    <message>
        <source>strut {part} by {by}; it extends to {limit}</source>
        <translation>支链 {part}，长了 {by}；最长可到 {limit}</translation>
    </message>
    <message>
        <source>base joints</source>
        <translation>底座铰链</translation>
    </message>
    <message>
        <source>platform joints</source>
        <translation>动平台铰链</translation>
    </message>
    <message>
        <source>below {least} by {by}</source>
        <translation>低于 {least}，差 {by}</translation>
    </message>
    <message>
        <source>stiffness along the normal</source>
        <translation>沿法向的刚度</translation>
    </message>
    <message>
        <source>{name} {value}, allowed {limit}, {time:.3f} s after the start</source>
        <translation>{name} {value}，允许 {limit}，开始后 {time:.3f} s</translation>
    </message>
    <message>
        <source>{name} {value}, at least {limit}, {time:.3f} s after the start</source>
        <translation>{name} {value}，至少 {limit}，开始后 {time:.3f} s</translation>
    </message>
</context>
<context>
    <name>CoreTexts</name>
    <message>
        <source>error</source>
        <translation>错误</translation>
    </message>
    <message>
        <source>warning</source>
        <translation>警告</translation>
    </message>
    <message>
        <source>line {}</source>
        <translation>第 {} 行</translation>
    </message>
    <message>
        <source>{code} {cause}: {found}; {cure}</source>
        <translation>{code} {cause}：{found}；{cure}</translation>
    </message>
    <message>
        <source>{place}: {severity} {code}: {cause}: {found}; {cure}</source>
        <translation>{place}：{severity} {code}：{cause}：{found}；{cure}</translation>
    </message>
</context>
<context>
    <name>DeviationMap</name>
    <message>
        <source>left: {}</source>
        <translation>残留：{}</translation>
    </message>
    <message>
        <source>gouged: {}</source>
        <translation>过切：{}</translation>
    </message>
    <message>
        <source>distance from the part</source>
        <translation>与零件的距离</translation>
    </message>
</context>
<context>
    <name>FaultLinks</name>
    <message>
        <source>{code}: {cause}.
What helps: {cure}.</source>
        <translation>{code}：{cause}。
解决办法：{cure}。</translation>
    </message>
</context>
<context>
    <name>GaugeTable</name>
    <message>
        <source>No.</source>
        <translation>编号</translation>
    </message>
    <message>
        <source>Number of the tool</source>
        <translation>刀具编号</translation>
    </message>
    <message>
        <source>Tool</source>
        <translation>刀具</translation>
    </message>
    <message>
        <source>Tool controller of the job</source>
        <translation>作业的刀具控制器</translation>
    </message>
    <message>
        <source>Bit</source>
        <translation>刀头</translation>
    </message>
    <message>
        <source>Length of the tool bit alone, to compare. It is no gauge length: part of the bit is in its holder, and the holder counts.</source>
        <translation>仅刀头本身的长度，供比较。它不是刀具长度：刀头有一部分在刀柄内，而且刀柄也计入长度。</translation>
    </message>
    <message>
        <source>Gauge length</source>
        <translation>刀具长度</translation>
    </message>
    <message>
        <source>From the spindle nose to the tip, measured with the tool in its holder</source>
        <translation>从主轴端面到刀尖，刀具装在刀柄中测得</translation>
    </message>
    <message>
        <source>Gauge lengths</source>
        <translation>刀具长度（主轴端面到刀尖）</translation>
    </message>
    <message>
        <source>T{}: {} of --tool-length in More arguments takes precedence over the field.</source>
        <translation>T{}：其他参数中 --tool-length 的 {} 优先于此输入框。</translation>
    </message>
</context>
<context>
    <name>JogPanel</name>
    <message>
        <source>X</source>
        <translation>X</translation>
    </message>
    <message>
        <source>Y</source>
        <translation>Y</translation>
    </message>
    <message>
        <source>Z</source>
        <translation>Z</translation>
    </message>
    <message>
        <source>Tilt about X</source>
        <translation>绕 X 倾斜</translation>
    </message>
    <message>
        <source>Tilt about Y</source>
        <translation>绕 Y 倾斜</translation>
    </message>
    <message>
        <source>Spin</source>
        <translation>自转角</translation>
    </message>
    <message>
        <source>Jog the machine</source>
        <translation>点动机床</translation>
    </message>
    <message>
        <source>Home</source>
        <translation>原位</translation>
    </message>
    <message>
        <source>Step</source>
        <translation>步长</translation>
    </message>
    <message>
        <source>Turn by</source>
        <translation>转角步长</translation>
    </message>
    <message>
        <source>The machine cannot reach this pose</source>
        <translation>机床不能处于此位姿</translation>
    </message>
    <message>
        <source>The machine can reach this pose</source>
        <translation>机床可以处于此位姿</translation>
    </message>
    <message>
        <source>Left: {} of a stroke, {} of a joint. Struts: {}</source>
        <translation>余量：行程 {}，铰链 {}。支链：{}</translation>
    </message>
</context>
<context>
    <name>LengthField</name>
    <message>
        <source>unknown</source>
        <translation>未知</translation>
    </message>
</context>
<context>
    <name>PKM_Control</name>
    <message>
        <source>Numerical control</source>
        <translation>数控面板</translation>
    </message>
    <message>
        <source>Operate a real or simulated machine: monitor, home, jog, run programs</source>
        <translation>操作机床或模拟机床：监视、回零、点动、运行程序</translation>
    </message>
</context>
<context>
    <name>PKM_Editor</name>
    <message>
        <source>Program editor</source>
        <translation>程序编辑器</translation>
    </message>
    <message>
        <source>Edit G-code or CL data, with faults shown as you type</source>
        <translation>编辑 G 代码或刀位文件，输入时即提示其中的错误</translation>
    </message>
    <message>
        <source>CUTCOM as in the file</source>
        <translation>CUTCOM：按文件说明</translation>
    </message>
    <message>
        <source>CUTCOM on the tool centre</source>
        <translation>CUTCOM：刀具中心</translation>
    </message>
    <message>
        <source>CUTCOM on the contour</source>
        <translation>CUTCOM：零件轮廓</translation>
    </message>
    <message>
        <source>Open end allowed</source>
        <translation>允许无结束</translation>
    </message>
    <message>
        <source>Flavour as in the file</source>
        <translation>方言：按文件说明</translation>
    </message>
    <message>
        <source>Dwells as in the flavour</source>
        <translation>暂停时间单位：按方言</translation>
    </message>
    <message>
        <source>Unit as in the file</source>
        <translation>单位：按文件说明</translation>
    </message>
    <message>
        <source>CAM system as in the file</source>
        <translation>CAM 系统：按文件说明</translation>
    </message>
    <message>
        <source>Tool axis words of the G-code</source>
        <translation>G 代码中刀轴的表示方式</translation>
    </message>
    <message>
        <source>Dialect of the G-code</source>
        <translation>G 代码的方言</translation>
    </message>
    <message>
        <source>The unit of dwells of the G-code</source>
        <translation>G 代码中暂停时间的单位</translation>
    </message>
    <message>
        <source>The unit of length of the part program</source>
        <translation>零件程序的长度单位</translation>
    </message>
    <message>
        <source>Meaning of the points of CL data under CUTCOM: tool centre or part contour</source>
        <translation>刀位文件中 CUTCOM 下的点是刀具中心还是零件轮廓</translation>
    </message>
    <message>
        <source>The CAM system that wrote the CL data</source>
        <translation>生成刀位文件的 CAM 系统</translation>
    </message>
    <message>
        <source>Accept a program without an end (M2, M30, %, FINI or END-OF-PATH)</source>
        <translation>接受没有以 M2、M30、% 或 FINI、END-OF-PATH 结束的程序</translation>
    </message>
    <message>
        <source>Not renumbered: line {} jumps to a block by its number</source>
        <translation>未重新编号：第 {} 行按编号跳转到程序段</translation>
    </message>
    <message>
        <source>{} replaced</source>
        <translation>已替换 {} 处</translation>
    </message>
    <message>
        <source>{} blocks, {} arcs, {}</source>
        <translation>{} 个程序段，{} 段圆弧，{}</translation>
    </message>
    <message>
        <source>Open</source>
        <translation>打开</translation>
    </message>
    <message>
        <source>Open a part program</source>
        <translation>打开零件程序</translation>
    </message>
    <message>
        <source>Save</source>
        <translation>保存</translation>
    </message>
    <message>
        <source>Save the part program</source>
        <translation>保存零件程序</translation>
    </message>
    <message>
        <source>Save as</source>
        <translation>另存为</translation>
    </message>
    <message>
        <source>Save under another name</source>
        <translation>以其他名称保存</translation>
    </message>
    <message>
        <source>Find</source>
        <translation>查找</translation>
    </message>
    <message>
        <source>Find and replace</source>
        <translation>查找和替换</translation>
    </message>
    <message>
        <source>Renumber</source>
        <translation>重新编号</translation>
    </message>
    <message>
        <source>Give each block a line number</source>
        <translation>为每个程序段加上行号</translation>
    </message>
    <message>
        <source>Decode</source>
        <translation>解码</translation>
    </message>
    <message>
        <source>Make it an operation of a CAM job</source>
        <translation>使其成为 CAM 作业的一个操作</translation>
    </message>
    <message>
        <source>Post</source>
        <translation>后处理</translation>
    </message>
    <message>
        <source>Write a certified motion program</source>
        <translation>写出经过验证的运动程序</translation>
    </message>
    <message>
        <source>Decode into a job</source>
        <translation>解码到作业中</translation>
    </message>
    <message>
        <source>No CAM job of the active document was chosen.</source>
        <translation>未选择活动文档中的 CAM 作业。</translation>
    </message>
    <message>
        <source>Save the changes of the part program?</source>
        <translation>是否保存对零件程序的更改？</translation>
    </message>
    <message>
        <source>Part programs</source>
        <translation>零件程序</translation>
    </message>
    <message>
        <source>Replace by</source>
        <translation>替换为</translation>
    </message>
    <message>
        <source>Go to the next match</source>
        <translation>转到下一处</translation>
    </message>
    <message>
        <source>Go to the previous match</source>
        <translation>转到上一处</translation>
    </message>
    <message>
        <source>Replace the selection and go to the next match</source>
        <translation>替换所选内容并转到下一处</translation>
    </message>
    <message>
        <source>Replace everywhere, in one step to undo</source>
        <translation>全部替换，可一步撤销</translation>
    </message>
    <message>
        <source>Next</source>
        <translation>下一个</translation>
    </message>
    <message>
        <source>Previous</source>
        <translation>上一个</translation>
    </message>
    <message>
        <source>Replace</source>
        <translation>替换</translation>
    </message>
    <message>
        <source>All</source>
        <translation>全部</translation>
    </message>
    <message>
        <source>Post program</source>
        <translation>后处理程序</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>取消</translation>
    </message>
    <message>
        <source>Stopped. Nothing was written.</source>
        <translation>已停止。未写出任何内容。</translation>
    </message>
    <message>
        <source>Certified and written:</source>
        <translation>已验证并写出：</translation>
    </message>
    <message>
        <source>Open in the editor</source>
        <translation>在编辑器中打开</translation>
    </message>
</context>
<context>
    <name>PKM_Example</name>
    <message>
        <source>New from example</source>
        <translation>从示例新建</translation>
    </message>
    <message>
        <source>Make a document with a blade and the job that finishes it on a hexapod</source>
        <translation>新建一个文档，内含叶片以及在六自由度并联机床上对其精加工的作业</translation>
    </message>
    <message>
        <source>Hexapod example</source>
        <translation>并联机床示例</translation>
    </message>
    <message>
        <source>A blade with a job for a hexapod machine tool, of PKM Post</source>
        <translation>PKM Post 的示例：叶片及其并联机床作业</translation>
    </message>
</context>
<context>
    <name>PKM_InstallPackages</name>
    <message>
        <source>Install packages</source>
        <translation>安装软件包</translation>
    </message>
    <message>
        <source>Install the optional Python packages that are missing here</source>
        <translation>安装此处缺少的可选 Python 软件包</translation>
    </message>
</context>
<context>
    <name>PKM_Machine</name>
    <message>
        <source>Machine</source>
        <translation>机床</translation>
    </message>
    <message>
        <source>Add the machine around the part, with the work offset of the job</source>
        <translation>按作业的工件偏置，在零件周围添加机床</translation>
    </message>
    <message>
        <source>Jog</source>
        <translation>点动</translation>
    </message>
    <message>
        <source>Move it home</source>
        <translation>移到零位</translation>
    </message>
</context>
<context>
    <name>PKM_Mirror</name>
    <message>
        <source>Mirror operation</source>
        <translation>镜像操作</translation>
    </message>
    <message>
        <source>Add the mirror image of the selected operation: plane, climb milling, report</source>
        <translation>添加所选操作的镜像：平面、顺铣、报告</translation>
    </message>
</context>
<context>
    <name>PKM_NormalCompensation</name>
    <message>
        <source>Normal Compensation</source>
        <translation>法向补偿</translation>
    </message>
    <message>
        <source>Treat the points of the selected operation as contact points of the cutter with the model</source>
        <translation>将所选操作的点作为模型上的接触点，使刀具在这些点接触模型</translation>
    </message>
</context>
<context>
    <name>PKM_Post</name>
    <message>
        <source>Post to a hexapod</source>
        <translation>后处理到六自由度并联机床</translation>
    </message>
    <message>
        <source>Write the certified motion program of the job</source>
        <translation>写出作业经过验证的运动程序</translation>
    </message>
</context>
<context>
    <name>PKM_Reach</name>
    <message>
        <source>Reach</source>
        <translation>可达性</translation>
    </message>
    <message>
        <source>Check whether the machine can follow the job, and colour its path</source>
        <translation>检查机床能否跟随作业，并为其轨迹着色</translation>
    </message>
    <message>
        <source>Check</source>
        <translation>检查项</translation>
    </message>
    <message>
        <source>Least margin</source>
        <translation>最小余量</translation>
    </message>
    <message>
        <source>Proven</source>
        <translation>已证明</translation>
    </message>
    <message>
        <source>Of</source>
        <translation>部件</translation>
    </message>
    <message>
        <source>Worst at</source>
        <translation>最差处</translation>
    </message>
    <message>
        <source>Colour by a check</source>
        <translation>按检查项着色</translation>
    </message>
    <message>
        <source>Colour by the worst check</source>
        <translation>按最差的检查着色</translation>
    </message>
    <message>
        <source>Not checked</source>
        <translation>未检查</translation>
    </message>
    <message>
        <source>The machine can follow the job</source>
        <translation>机床能够跟随该作业</translation>
    </message>
    <message>
        <source>The machine cannot follow the job</source>
        <translation>机床不能跟随该作业</translation>
    </message>
    <message>
        <source>points only</source>
        <translation>仅各点</translation>
    </message>
    <message>
        <source>{}, line {}</source>
        <translation>{}，第 {} 行</translation>
    </message>
    <message>
        <source>Open the findings</source>
        <translation>打开检查结果</translation>
    </message>
    <message>
        <source>worst check</source>
        <translation>最差的检查</translation>
    </message>
    <message>
        <source>{} of the largest</source>
        <translation>最大值的 {}</translation>
    </message>
    <message>
        <source>out of limits</source>
        <translation>超出极限</translation>
    </message>
</context>
<context>
    <name>PKM_Rotate</name>
    <message>
        <source>Rotate operation</source>
        <translation>旋转操作</translation>
    </message>
    <message>
        <source>Add copies of the selected operation, rotated about an axis</source>
        <translation>添加所选操作绕轴线旋转一次或多次的副本</translation>
    </message>
</context>
<context>
    <name>PKM_Simulate</name>
    <message>
        <source>Simulation</source>
        <translation>仿真</translation>
    </message>
    <message>
        <source>CAM&apos;s simulator needs the task panel: close the open task first</source>
        <translation>CAM 仿真器需要任务面板：请先关闭其中打开的内容</translation>
    </message>
    <message>
        <source>CAM&apos;s simulator does not accept this job</source>
        <translation>CAM 仿真器不接受此作业</translation>
    </message>
    <message>
        <source>Simulate</source>
        <translation>仿真</translation>
    </message>
    <message>
        <source>Play the planned motion of the job on its machine</source>
        <translation>在机床上播放作业的规划运动</translation>
    </message>
    <message>
        <source>Pictures</source>
        <translation>图片</translation>
    </message>
    <message>
        <source>{} of {} pictures were written</source>
        <translation>已写出 {} 幅图片，共 {} 幅</translation>
    </message>
    <message>
        <source>Folder for the pictures</source>
        <translation>图片文件夹</translation>
    </message>
    <message>
        <source>Animated PNG</source>
        <translation>PNG 动画</translation>
    </message>
    <message>
        <source>Animated PNG (*.png)</source>
        <translation>PNG 动画 (*.png)</translation>
    </message>
    <message>
        <source>{}, line {}</source>
        <translation>{}，第 {} 行</translation>
    </message>
    <message>
        <source>At this override strut {} would have to do {} of {} {}</source>
        <translation>在此倍率下，支链 {} 的速度须达 {}，而极限为 {} {}</translation>
    </message>
    <message>
        <source>Play and pause</source>
        <translation>播放和暂停</translation>
    </message>
    <message>
        <source>To the beginning of the block</source>
        <translation>到程序段的起点</translation>
    </message>
    <message>
        <source>To the end of the block</source>
        <translation>到程序段的终点</translation>
    </message>
    <message>
        <source>Override</source>
        <translation>倍率</translation>
    </message>
    <message>
        <source>Write the frames as pictures</source>
        <translation>将各帧写为图片</translation>
    </message>
    <message>
        <source>Write an animated PNG</source>
        <translation>写为 PNG 动画</translation>
    </message>
    <message>
        <source>Removal of material, in CAM&apos;s own simulator; it shows every tool upright</source>
        <translation>在 CAM 自带的仿真器中显示材料去除；其中所有刀具均显示为竖直</translation>
    </message>
    <message>
        <source>Playback speed relative to the machine</source>
        <translation>相对机床速度的倍数</translation>
    </message>
    <message>
        <source>Feed override: the machine&apos;s own time runs slower or faster</source>
        <translation>进给倍率：机床自身的时间变慢或变快</translation>
    </message>
    <message>
        <source>Stop at problems</source>
        <translation>遇到问题时停止</translation>
    </message>
    <message>
        <source>Problems: {}</source>
        <translation>问题：{}</translation>
    </message>
    <message>
        <source>Operations: {}</source>
        <translation>操作：{}</translation>
    </message>
    <message>
        <source>Open the player</source>
        <translation>打开播放器</translation>
    </message>
    <message>
        <source>Readout</source>
        <translation>读数</translation>
    </message>
    <message>
        <source>Program</source>
        <translation>程序</translation>
    </message>
    <message>
        <source>Material</source>
        <translation>材料</translation>
    </message>
    <message>
        <source>View</source>
        <translation>视图</translation>
    </message>
    <message>
        <source>Colour by the distance from the part</source>
        <translation>按与零件的距离着色</translation>
    </message>
    <message>
        <source>No material</source>
        <translation>不显示材料</translation>
    </message>
    <message>
        <source>Material: {}</source>
        <translation>材料：{}</translation>
    </message>
    <message>
        <source>Cutting: {} of {}</source>
        <translation>切削中：{} / {}</translation>
    </message>
    <message>
        <source>Coarse, {}</source>
        <translation>粗，{}</translation>
    </message>
    <message>
        <source>Medium, {}</source>
        <translation>中，{}</translation>
    </message>
    <message>
        <source>Fine, {}</source>
        <translation>细，{}</translation>
    </message>
    <message>
        <source>The job has no stock: choose one in its Setup.</source>
        <translation>作业没有毛坯：请在其“设置”中选择。</translation>
    </message>
    <message>
        <source>The surface of the stock is not closed.</source>
        <translation>毛坯的表面不封闭。</translation>
    </message>
    <message>
        <source>Left on the part: {}, up to {} thick</source>
        <translation>零件上的余量：{}，最厚 {}</translation>
    </message>
    <message>
        <source>Missing from the part: {}, up to {} deep</source>
        <translation>零件缺失：{}，最深 {}</translation>
    </message>
    <message>
        <source>at least {}</source>
        <translation>至少 {}</translation>
    </message>
    <message>
        <source>Strut {}</source>
        <translation>支链 {}</translation>
    </message>
    <message>
        <source>Feed</source>
        <translation>进给</translation>
    </message>
    <message>
        <source>Asked</source>
        <translation>要求</translation>
    </message>
    <message>
        <source>Line</source>
        <translation>行</translation>
    </message>
    <message>
        <source>Left</source>
        <translation>剩余</translation>
    </message>
    <message>
        <source>Shown</source>
        <translation>显示</translation>
    </message>
    <message>
        <source>Transparent</source>
        <translation>透明</translation>
    </message>
    <message>
        <source>Hidden</source>
        <translation>隐藏</translation>
    </message>
    <message>
        <source>Follow the tool</source>
        <translation>跟随刀具</translation>
    </message>
    <message>
        <source>Section plane</source>
        <translation>剖切平面</translation>
    </message>
    <message>
        <source>none</source>
        <translation>无</translation>
    </message>
    <message>
        <source>Tool axis every ... blocks</source>
        <translation>每 … 个程序段显示刀轴</translation>
    </message>
    <message>
        <source>Base</source>
        <translation>底座</translation>
    </message>
    <message>
        <source>Struts</source>
        <translation>支链</translation>
    </message>
    <message>
        <source>Platform and spindle</source>
        <translation>动平台与主轴</translation>
    </message>
    <message>
        <source>Tool</source>
        <translation>刀具</translation>
    </message>
    <message>
        <source>Lengths, {}</source>
        <translation>杆长，{}</translation>
    </message>
    <message>
        <source>Speeds, {}</source>
        <translation>速度，{}</translation>
    </message>
</context>
<context>
    <name>PKM_Stiffness</name>
    <message>
        <source>Stiffness</source>
        <translation>刚度</translation>
    </message>
    <message>
        <source>Show the stiffness of the tool tip along the job and over the table</source>
        <translation>显示刀具沿作业以及在工作台上的支承刚度</translation>
    </message>
</context>
<context>
    <name>PKM_SurfaceFinish</name>
    <message>
        <source>Surface Finish (5-axis)</source>
        <translation>曲面精加工（五轴）</translation>
    </message>
    <message>
        <source>Cover the selected faces of a job&apos;s model with passes of a leaning tool</source>
        <translation>以倾斜刀具的走刀覆盖作业模型的所选面</translation>
    </message>
    <message>
        <source>Coolant</source>
        <translation>冷却液</translation>
    </message>
    <message>
        <source>Lines</source>
        <translation>走刀线</translation>
    </message>
    <message>
        <source>Order</source>
        <translation>顺序</translation>
    </message>
    <message>
        <source>Cut mode</source>
        <translation>铣削方式</translation>
    </message>
    <message>
        <source>Begin at the other side</source>
        <translation>从另一侧开始</translation>
    </message>
    <message>
        <source>Stepover by</source>
        <translation>行距依据</translation>
    </message>
    <message>
        <source>Distance</source>
        <translation>距离</translation>
    </message>
    <message>
        <source>Scallop height</source>
        <translation>残留高度</translation>
    </message>
    <message>
        <source>Chord tolerance</source>
        <translation>弦高公差</translation>
    </message>
    <message>
        <source>Axis tolerance</source>
        <translation>刀轴公差</translation>
    </message>
    <message>
        <source>Lead</source>
        <translation>前倾角</translation>
    </message>
    <message>
        <source>Tilt</source>
        <translation>侧倾角</translation>
    </message>
    <message>
        <source>Cone limit</source>
        <translation>锥角极限</translation>
    </message>
    <message>
        <source>Approach distance</source>
        <translation>接近距离</translation>
    </message>
    <message>
        <source>Lead-in and lead-out</source>
        <translation>进刀和退刀</translation>
    </message>
    <message>
        <source>Length of leads</source>
        <translation>进退刀长度</translation>
    </message>
    <message>
        <source>Check points, distance</source>
        <translation>检查点间距</translation>
    </message>
    <message>
        <source>None</source>
        <translation>无</translation>
    </message>
    <message>
        <source>Flood</source>
        <translation>浇注</translation>
    </message>
    <message>
        <source>Mist</source>
        <translation>喷雾</translation>
    </message>
    <message>
        <source>Along U</source>
        <translation>沿 U 方向</translation>
    </message>
    <message>
        <source>Along V</source>
        <translation>沿 V 方向</translation>
    </message>
    <message>
        <source>Parallel planes</source>
        <translation>平行平面</translation>
    </message>
    <message>
        <source>Zigzag</source>
        <translation>往复</translation>
    </message>
    <message>
        <source>One way</source>
        <translation>单向</translation>
    </message>
    <message>
        <source>Spiral</source>
        <translation>螺旋</translation>
    </message>
    <message>
        <source>Climb</source>
        <translation>顺铣</translation>
    </message>
    <message>
        <source>Conventional</source>
        <translation>逆铣</translation>
    </message>
    <message>
        <source>As it comes</source>
        <translation>不限</translation>
    </message>
    <message>
        <source>Tangent</source>
        <translation>相切</translation>
    </message>
    <message>
        <source>Arc</source>
        <translation>圆弧</translation>
    </message>
    <message>
        <source>Measure and colour again</source>
        <translation>重新测量并着色</translation>
    </message>
    <message>
        <source>The document keeps the worst values, not the colours: computes them again</source>
        <translation>文档只保存最差值，不保存颜色：重新计算</translation>
    </message>
    <message>
        <source>Tool controller</source>
        <translation>刀具控制器</translation>
    </message>
</context>
<context>
    <name>PackageInstall</name>
    <message>
        <source>Install packages</source>
        <translation>安装软件包</translation>
    </message>
    <message>
        <source>G-code and CL data</source>
        <translation>G代码和CL数据</translation>
    </message>
    <message>
        <source>serial lines to a controller</source>
        <translation>连接控制器的串口</translation>
    </message>
    <message>
        <source>ssh to a Power PMAC</source>
        <translation>通过 ssh 连接 Power PMAC</translation>
    </message>
    <message>
        <source>pictures of reports and reach maps</source>
        <translation>报告和可达图的图片</translation>
    </message>
    <message>
        <source>Missing:</source>
        <translation>缺少：</translation>
    </message>
    <message>
        <source>All packages are installed.</source>
        <translation>所有软件包均已安装。</translation>
    </message>
    <message>
        <source>Download and install</source>
        <translation>下载并安装</translation>
    </message>
    <message>
        <source>Install from a folder...</source>
        <translation>从文件夹安装...</translation>
    </message>
    <message>
        <source>Installing packages...</source>
        <translation>正在安装软件包...</translation>
    </message>
    <message>
        <source>The packages are installed.</source>
        <translation>软件包已安装。</translation>
    </message>
</context>
<context>
    <name>PlaceRow</name>
    <message>
        <source>Stop</source>
        <translation>停止</translation>
    </message>
    <message>
        <source>Stop the search, as Escape does</source>
        <translation>停止搜索，与 Escape 键相同</translation>
    </message>
    <message>
        <source>Find a place</source>
        <translation>寻找位置</translation>
    </message>
    <message>
        <source>Search for a work offset, and if necessary another spin, with which the machine can follow</source>
        <translation>寻找机床能够跟随的工件偏置，必要时使用另一种自转角</translation>
    </message>
    <message>
        <source>Use this place</source>
        <translation>采用此位置</translation>
    </message>
    <message>
        <source>Set it as --work-offset, and --spin, in the arguments of the job</source>
        <translation>将其作为 --work-offset 和 --spin 写入作业的参数</translation>
    </message>
    <message>
        <source>Looking for a place ...</source>
        <translation>正在寻找位置……</translation>
    </message>
    <message>
        <source>Stopped.</source>
        <translation>已停止。</translation>
    </message>
    <message>
        <source>shift {amount} in {axis}</source>
        <translation>沿 {axis} 平移 {amount}</translation>
    </message>
    <message>
        <source>turn {amount} about {axis}</source>
        <translation>绕 {axis} 旋转 {amount}</translation>
    </message>
    <message>
        <source>where it is</source>
        <translation>原位置</translation>
    </message>
    <message>
        <source>spin optimised</source>
        <translation>优化自转角</translation>
    </message>
    <message>
        <source>No place was found. The last one tried: {}; there: {}</source>
        <translation>未找到位置。尝试过的最后一个：{}；在那里：{}</translation>
    </message>
    <message>
        <source>{} to spare</source>
        <translation>余量 {}</translation>
    </message>
    <message>
        <source>{}: the machine can follow, {}</source>
        <translation>{}：机床能够跟随，{}</translation>
    </message>
</context>
<context>
    <name>PostChoices</name>
    <message>
        <source>Shortest rotation from upright</source>
        <translation>从竖直方向的最短旋转</translation>
    </message>
    <message>
        <source>As in the part program</source>
        <translation>按零件程序</translation>
    </message>
    <message>
        <source>x axis in a vertical plane</source>
        <translation>x 轴在竖直平面内</translation>
    </message>
    <message>
        <source>y axis in a vertical plane</source>
        <translation>y 轴在竖直平面内</translation>
    </message>
    <message>
        <source>Most stroke left</source>
        <translation>剩余行程最大</translation>
    </message>
    <message>
        <source>Most swing of the joints left</source>
        <translation>铰链剩余摆角最大</translation>
    </message>
    <message>
        <source>Farthest from singular poses</source>
        <translation>离奇异位姿最远</translation>
    </message>
    <message>
        <source>Most left of all three</source>
        <translation>三者综合余量最大</translation>
    </message>
    <message>
        <source>Table of the strut motion (CSV)</source>
        <translation>支链运动表 (CSV)</translation>
    </message>
    <message>
        <source>Table for LinuxCNC&apos;s halstreamer</source>
        <translation>LinuxCNC halstreamer 用的表</translation>
    </message>
    <message>
        <source>G-code for LinuxCNC&apos;s hexapod, not certified</source>
        <translation>LinuxCNC 六杆机床的 G 代码，未经验证</translation>
    </message>
    <message>
        <source>Picture of the report (PNG)</source>
        <translation>报告图片 (PNG)</translation>
    </message>
    <message>
        <source>Program in X Y Z A B C</source>
        <translation>X Y Z A B C 程序</translation>
    </message>
    <message>
        <source>Machine</source>
        <translation>机床</translation>
    </message>
    <message>
        <source>A name, or a file</source>
        <translation>名称或文件</translation>
    </message>
    <message>
        <source>Work offset</source>
        <translation>工件偏置</translation>
    </message>
    <message>
        <source>Name of a work offset of the machine, or X,Y,Z[,degrees about z] in mm</source>
        <translation>机床的工件偏置名称，或 X,Y,Z[,绕 z 轴的度数]，单位 mm</translation>
    </message>
    <message>
        <source>Tip tolerance</source>
        <translation>刀尖公差</translation>
    </message>
    <message>
        <source>Largest deviation of the tool tip from the programmed path</source>
        <translation>刀尖偏离编程路径的最大允许距离</translation>
    </message>
    <message>
        <source>Axis tolerance</source>
        <translation>刀轴公差</translation>
    </message>
    <message>
        <source>Largest deviation of the tool axis from the programmed axis</source>
        <translation>刀轴偏离编程刀轴的最大允许角度</translation>
    </message>
    <message>
        <source>Spin</source>
        <translation>自转角</translation>
    </message>
    <message>
        <source>Rotation of the platform about the tool axis</source>
        <translation>动平台绕刀轴转动的方式</translation>
    </message>
    <message>
        <source>Heading</source>
        <translation>朝向</translation>
    </message>
    <message>
        <source>Direction of the platform&apos;s axis with the tool upright</source>
        <translation>刀具竖直时动平台的轴所指的方向</translation>
    </message>
    <message>
        <source>Also write</source>
        <translation>同时写出</translation>
    </message>
    <message>
        <source>Additional outputs</source>
        <translation>除程序外还要写出的内容</translation>
    </message>
    <message>
        <source>More arguments</source>
        <translation>其他参数</translation>
    </message>
    <message>
        <source>Arguments that have no field here, such as --surface-speed 120, or --tool-length 1=120 for a part program</source>
        <translation>此处没有输入框的参数，例如 --surface-speed 120，或用于零件程序的 --tool-length 1=120</translation>
    </message>
    <message>
        <source>Folder</source>
        <translation>文件夹</translation>
    </message>
    <message>
        <source>Where the files are written</source>
        <translation>文件写出的位置</translation>
    </message>
    <message>
        <source>the example machine, example_6tps</source>
        <translation>示例机床 example_6tps</translation>
    </message>
    <message>
        <source>the fixture of the job</source>
        <translation>作业的工件坐标系</translation>
    </message>
    <message>
        <source>Machine file</source>
        <translation>机床文件</translation>
    </message>
    <message>
        <source>Machine files</source>
        <translation>机床文件</translation>
    </message>
    <message>
        <source>Folder for the files</source>
        <translation>文件所在的文件夹</translation>
    </message>
</context>
<context>
    <name>PostOutcome</name>
    <message>
        <source>Measured</source>
        <translation>测量项</translation>
    </message>
    <message>
        <source>Worst</source>
        <translation>最差值</translation>
    </message>
    <message>
        <source>Limit</source>
        <translation>极限</translation>
    </message>
    <message>
        <source>Unit</source>
        <translation>单位</translation>
    </message>
    <message>
        <source>Where</source>
        <translation>位置</translation>
    </message>
    <message>
        <source>Open the report</source>
        <translation>打开报告</translation>
    </message>
    <message>
        <source>Shows the report in the web browser; no network is needed</source>
        <translation>在网页浏览器中显示报告；不需要网络</translation>
    </message>
    <message>
        <source>Refused. Nothing was written.</source>
        <translation>已拒绝。未写出任何内容。</translation>
    </message>
    <message>
        <source>Certified to the extent stated below ({} poses computed). {} s at the machine, {} files.</source>
        <translation>已验证，范围如下各行所述（计算了 {} 个位姿）。加工用时 {} 秒，{} 个文件。</translation>
    </message>
    <message>
        <source>{}: not posted</source>
        <translation>{}：未输出</translation>
    </message>
</context>
<context>
    <name>PostPanel</name>
    <message>
        <source>Post to a hexapod</source>
        <translation>后处理到六自由度并联机床</translation>
    </message>
    <message>
        <source>Post</source>
        <translation>后处理</translation>
    </message>
    <message>
        <source>Write the certified motion program and its accompanying files</source>
        <translation>写出经过验证的运动程序及其附带文件</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>取消</translation>
    </message>
    <message>
        <source>Open folder</source>
        <translation>打开文件夹</translation>
    </message>
    <message>
        <source>Show the files that were written</source>
        <translation>显示已写出的文件</translation>
    </message>
    <message>
        <source>Simulate</source>
        <translation>仿真</translation>
    </message>
    <message>
        <source>Play the planned motion of the job</source>
        <translation>播放作业的规划运动</translation>
    </message>
    <message>
        <source>Stop after the current step, and write nothing</source>
        <translation>完成当前步骤后停止，不写出任何内容</translation>
    </message>
    <message>
        <source>Stopping after this step</source>
        <translation>此步骤完成后将停止</translation>
    </message>
    <message>
        <source>Stopped. Nothing was written.</source>
        <translation>已停止。未写出任何内容。</translation>
    </message>
    <message>
        <source>Internal error; see the Report view.</source>
        <translation>软件出错；详见报告视图。</translation>
    </message>
    <message>
        <source>Store the choices in the document without posting</source>
        <translation>将所选内容保存到文档中，不进行后处理</translation>
    </message>
    <message>
        <source>Stored in the document. Nothing was posted.</source>
        <translation>已保存到文档中。未进行后处理。</translation>
    </message>
    <message>
        <source>Another task panel is open: close it first.</source>
        <translation>另一个任务面板已打开：请先关闭。</translation>
    </message>
</context>
<context>
    <name>PostPreferences</name>
    <message>
        <source>Posting</source>
        <translation>后处理</translation>
    </message>
    <message>
        <source>the folder of the document</source>
        <translation>文档所在的文件夹</translation>
    </message>
    <message>
        <source>Initial values of the post panel for a job without arguments of its own.</source>
        <translation>对没有自身参数的作业，后处理面板最初显示的内容。</translation>
    </message>
    <message>
        <source>Along paths of five axes, in Reach and in the player</source>
        <translation>沿五轴轨迹，在可达性检查和播放器中</translation>
    </message>
</context>
<context>
    <name>PostSteps</name>
    <message>
        <source>Reading</source>
        <translation>读取</translation>
    </message>
    <message>
        <source>Trajectory</source>
        <translation>轨迹</translation>
    </message>
    <message>
        <source>Reach and feed plan</source>
        <translation>可达性和进给规划</translation>
    </message>
    <message>
        <source>Collisions</source>
        <translation>碰撞检查</translation>
    </message>
    <message>
        <source>Interpolation</source>
        <translation>插补</translation>
    </message>
    <message>
        <source>Motion program</source>
        <translation>运动程序</translation>
    </message>
    <message>
        <source>Certificate</source>
        <translation>验证</translation>
    </message>
    <message>
        <source>Report</source>
        <translation>报告</translation>
    </message>
    <message>
        <source>Table of the strut motion</source>
        <translation>支链运动表</translation>
    </message>
    <message>
        <source>Table for halstreamer</source>
        <translation>halstreamer 用的表</translation>
    </message>
    <message>
        <source>G-code for LinuxCNC</source>
        <translation>LinuxCNC 的 G 代码</translation>
    </message>
    <message>
        <source>Program in X Y Z A B C</source>
        <translation>X Y Z A B C 程序</translation>
    </message>
    <message>
        <source>Moving the files to their folder</source>
        <translation>将文件移入文件夹</translation>
    </message>
</context>
<context>
    <name>Progress</name>
    <message>
        <source>Post</source>
        <translation>后处理</translation>
    </message>
    <message>
        <source>{}: stopped at {}</source>
        <translation>{}：停止于 {}</translation>
    </message>
    <message>
        <source>{}: {} done. Escape stops it.</source>
        <translation>{}：已完成 {}。按 Esc 键停止。</translation>
    </message>
    <message>
        <source>{}: gouges</source>
        <translation>{}：过切</translation>
    </message>
</context>
<context>
    <name>Sanity</name>
    <message>
        <source>The machine can follow the job</source>
        <translation>机床能够跟随该作业</translation>
    </message>
</context>
<context>
    <name>StiffnessPanel</name>
    <message>
        <source>Stiffness of {}</source>
        <translation>{} 的刚度</translation>
    </message>
    <message>
        <source>Show the table: tool upright, lowest height of the job</source>
        <translation>显示工作台：刀具竖直，位于作业的最低高度</translation>
    </message>
    <message>
        <source>Stiffness of the tool tip in the softest direction: {} to {}</source>
        <translation>各支链在最软方向上支承刀尖的刚度为 {} 至 {}</translation>
    </message>
    <message>
        <source>stiffness</source>
        <translation>刚度</translation>
    </message>
    <message>
        <source>Stiffness</source>
        <translation>刚度</translation>
    </message>
    <message>
        <source>{}, line {}: {} along ({}) of the machine</source>
        <translation>{}，第 {} 行：{}，沿机床方向 ({})</translation>
    </message>
</context>
<context>
    <name>SurfaceFinish</name>
    <message>
        <source>The machine cannot follow</source>
        <translation>机床无法跟随</translation>
    </message>
    <message>
        <source>The machine can follow</source>
        <translation>机床可以跟随</translation>
    </message>
    <message>
        <source>Not computed yet: Apply computes it</source>
        <translation>尚未计算：按“应用”进行计算</translation>
    </message>
    <message>
        <source>Gouges are not checked: set a distance of check points</source>
        <translation>未检查过切：请设置检查点间距</translation>
    </message>
    <message>
        <source>No gouge: {} at the deepest, between the points at most {} deeper; {} left at most, at points {} apart</source>
        <translation>无过切：最深 {}，检查点之间最多再深 {}；最多残留 {}，检查点间距 {}</translation>
    </message>
</context>
<context>
    <name>SymmetryPanel</name>
    <message>
        <source>Plane</source>
        <translation>平面</translation>
    </message>
    <message>
        <source>XY</source>
        <translation>XY</translation>
    </message>
    <message>
        <source>XZ</source>
        <translation>XZ</translation>
    </message>
    <message>
        <source>YZ</source>
        <translation>YZ</translation>
    </message>
    <message>
        <source>Pick a flat face or a datum plane</source>
        <translation>拾取平面或基准平面</translation>
    </message>
    <message>
        <source>Axis</source>
        <translation>轴线</translation>
    </message>
    <message>
        <source>X</source>
        <translation>X</translation>
    </message>
    <message>
        <source>Y</source>
        <translation>Y</translation>
    </message>
    <message>
        <source>Z</source>
        <translation>Z</translation>
    </message>
    <message>
        <source>Pick an edge, a round face or a datum line</source>
        <translation>拾取边、回转面或基准线</translation>
    </message>
    <message>
        <source>Edit symmetric operation</source>
        <translation>编辑对称操作</translation>
    </message>
    <message>
        <source>Picked</source>
        <translation>拾取</translation>
    </message>
    <message>
        <source>Typed in</source>
        <translation>输入</translation>
    </message>
    <message>
        <source>Direction</source>
        <translation>方向</translation>
    </message>
    <message>
        <source>Point</source>
        <translation>点</translation>
    </message>
    <message>
        <source>Keep climb milling: reverse the passes</source>
        <translation>保持顺铣：反向走刀</translation>
    </message>
    <message>
        <source>such as 90; 180; 270, in place of the two above</source>
        <translation>例如 90; 180; 270，代替以上两项</translation>
    </message>
    <message>
        <source>Angle</source>
        <translation>角度</translation>
    </message>
    <message>
        <source>Copies</source>
        <translation>副本数</translation>
    </message>
    <message>
        <source>Angles</source>
        <translation>角度列表</translation>
    </message>
    <message>
        <source>Material</source>
        <translation>材料</translation>
    </message>
    <message>
        <source>It depends on this operation</source>
        <translation>它依赖于本操作</translation>
    </message>
    <message>
        <source>climb milling</source>
        <translation>顺铣</translation>
    </message>
    <message>
        <source>conventional milling</source>
        <translation>逆铣</translation>
    </message>
    <message>
        <source>climb and conventional milling</source>
        <translation>顺铣和逆铣</translation>
    </message>
    <message>
        <source>not known</source>
        <translation>未知</translation>
    </message>
    <message>
        <source>Nothing is copied</source>
        <translation>没有复制任何内容</translation>
    </message>
    <message>
        <source>Climb or conventional is unknown: state the side of the material</source>
        <translation>顺铣或逆铣未知：请说明材料在哪一侧</translation>
    </message>
    <message>
        <source>Original: {}</source>
        <translation>原操作：{}</translation>
    </message>
    <message>
        <source>Copies: {}</source>
        <translation>副本：{}</translation>
    </message>
    <message>
        <source>Reversed passes: {}</source>
        <translation>反向走刀的次数：{}</translation>
    </message>
    <message>
        <source>Arcs with reversed sense: {}</source>
        <translation>反向的圆弧数：{}</translation>
    </message>
    <message>
        <source>Between original and copy: {}</source>
        <translation>原操作与副本之间：{}</translation>
    </message>
    <message>
        <source>Both cut over a width of {}</source>
        <translation>两者都切削的宽度：{}</translation>
    </message>
    <message>
        <source>Original and copies: {}</source>
        <translation>原操作和副本：{}</translation>
    </message>
    <message>
        <source>full circle, no overlap</source>
        <translation>布满整周，互不重叠</translation>
    </message>
    <message>
        <source>{} covered, {} covered twice, widest gap {}</source>
        <translation>覆盖 {}，重复覆盖 {}，最大间隙 {}</translation>
    </message>
    <message>
        <source>No path of one ends where a path of another begins: the tool is lifted between them. For one continuous path, end the passes of the original at the plane or at the edges of its sector.</source>
        <translation>没有一条轨迹的终点与另一条轨迹的起点相接：其间刀具会抬起。要得到一条连续的轨迹，请让原始操作的各行在平面处或其扇区的边缘处结束。</translation>
    </message>
    <message>
        <source>Where they meet ({}): tips {} apart, tool axes by {}</source>
        <translation>相接处（{} 处）：刀尖相距 {}，刀轴相差 {}</translation>
    </message>
    <message>
        <source>{} with all its copies in the job, {} in number: {}</source>
        <translation>{} 及其在作业中的所有副本，共 {} 个：{}</translation>
    </message>
    <message>
        <source>Edit</source>
        <translation>编辑</translation>
    </message>
    <message>
        <source>As stated by the original</source>
        <translation>按原操作的设定</translation>
    </message>
    <message>
        <source>Left of the original&apos;s path</source>
        <translation>原路径左侧</translation>
    </message>
    <message>
        <source>Right of the original&apos;s path</source>
        <translation>原路径右侧</translation>
    </message>
</context>
<context>
    <name>Workbench</name>
    <message>
        <source>Post CAM jobs to hexapod machine tools</source>
        <translation>将 CAM 作业后处理到六自由度并联机床</translation>
    </message>
</context>
</TS>
